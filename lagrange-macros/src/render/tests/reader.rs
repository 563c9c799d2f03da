//! Reads formulas in Unicode as a person would, and refuses what could be read in two ways.

use super::POINT;

/// The value of the text at [`POINT`].
pub(super) fn read(text: &str) -> f64 {
    let mut reader = Reader { text: text.chars().collect(), at: 0 };
    let value = reader.sum();
    assert_eq!(reader.at, reader.text.len(), "«{text}» goes on after {}", reader.at);
    value
}

pub(super) fn apply(function: &str, arguments: &[f64]) -> f64 {
    match (function, arguments) {
        ("sin", [x]) => x.sin(),
        ("exp", [x]) => x.exp(),
        ("asin", [x]) => x.sin() + 3.0,
        ("abs", [x]) => x.abs(),
        // Of numbers, as if they were vectors of one.
        ("dot", [x, y]) => x * y,
        ("atan2", [y, x]) => y.atan2(*x),
        ("f", [x, y]) => x - 2.0 * y,
        _ => panic!("no function {function} of {}", arguments.len()),
    }
}

struct Reader {
    text: Vec<char>,
    at: usize,
}

const SUPERSCRIPTS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";

const FRACTIONS: [(char, f64); 15] = [
    ('½', 1.0 / 2.0),
    ('⅓', 1.0 / 3.0),
    ('⅔', 2.0 / 3.0),
    ('¼', 1.0 / 4.0),
    ('¾', 3.0 / 4.0),
    ('⅕', 1.0 / 5.0),
    ('⅖', 2.0 / 5.0),
    ('⅗', 3.0 / 5.0),
    ('⅘', 4.0 / 5.0),
    ('⅙', 1.0 / 6.0),
    ('⅚', 5.0 / 6.0),
    ('⅛', 1.0 / 8.0),
    ('⅜', 3.0 / 8.0),
    ('⅝', 5.0 / 8.0),
    ('⅞', 7.0 / 8.0),
];

impl Reader {
    fn take(&mut self, word: &str) -> bool {
        let found = self.text[self.at..].iter().copied().take(word.chars().count()).eq(word.chars());
        if found {
            self.at += word.chars().count();
        }
        found
    }

    fn expect(&mut self, word: &str) {
        let rest: String = self.text[self.at..].iter().collect();
        assert!(self.take(word), "«{word}» expected before «{rest}»");
    }

    fn peek(&self) -> Option<char> {
        self.text.get(self.at).copied()
    }

    fn sum(&mut self) -> f64 {
        let mut total = if self.take("−") { -self.product() } else { self.product() };
        loop {
            if self.take(" + ") {
                total += self.product();
            } else if self.take(" − ") {
                total -= self.product();
            } else {
                return total;
            }
        }
    }

    /// Factors side by side, a dot product as the last of them, or one fraction.
    fn product(&mut self) -> f64 {
        let mut value = self.power();
        loop {
            if self.take(" · ") || (self.continues() && self.take(" ")) {
                value *= self.power();
            } else if self.take("·") {
                return value * self.power();
            } else if self.take("/") {
                return value / self.power();
            } else {
                return value;
            }
        }
    }

    /// Whether a factor comes next, and not a sign.
    fn continues(&self) -> bool {
        self.peek() == Some(' ') && !matches!(self.text.get(self.at + 1), Some('+' | '−' | '·'))
    }

    fn power(&mut self) -> f64 {
        let base = self.atom();
        let value = match self.superscript() {
            Some(exponent) => base.powf(exponent),
            None if self.take("^") => {
                let exponent = self.atom();
                base.powf(exponent)
            }
            None => base,
        };
        assert!(!matches!(self.peek(), Some('^')), "a tower without parentheses");
        value
    }

    fn superscript(&mut self) -> Option<f64> {
        let negative = self.take("⁻");
        let mut digits = String::new();
        while let Some(digit) =
            self.peek().and_then(|sign| SUPERSCRIPTS.chars().position(|known| known == sign))
        {
            digits += &digit.to_string();
            self.at += 1;
        }
        let value: f64 = digits.parse().ok()?;
        Some(if negative { -value } else { value })
    }

    fn atom(&mut self) -> f64 {
        if self.take("(") {
            let value = self.sum();
            self.expect(")");
            return value;
        }
        if self.take("√") {
            return self.atom().sqrt();
        }
        if self.take("|") {
            let value = self.sum();
            self.expect("|");
            return value.abs();
        }
        match self.peek() {
            Some(first) if first.is_ascii_digit() => self.number(),
            Some(first) if first.is_ascii_alphabetic() => self.word(),
            Some(first) => {
                self.at += 1;
                FRACTIONS.into_iter().find(|(sign, _)| *sign == first).expect("a fraction").1
            }
            None => panic!("the text ends too early"),
        }
    }

    /// `12`, `9.81`, `10/7`
    fn number(&mut self) -> f64 {
        let above = self.digits();
        let digit_follows = self.text.get(self.at + 1).is_some_and(char::is_ascii_digit);
        if self.peek() == Some('/') && digit_follows {
            let before = self.at;
            self.at += 1;
            let below = self.digits();
            // In 2/3² the exponent belongs to the 3.
            if !matches!(self.peek(), Some('^' | '⁻'))
                && !self.peek().is_some_and(|c| SUPERSCRIPTS.contains(c))
            {
                return above / below;
            }
            self.at = before;
        }
        above
    }

    fn digits(&mut self) -> f64 {
        let rest = &self.text[self.at..];
        let digits: String = rest.iter().take_while(|c| c.is_ascii_digit() || **c == '.').collect();
        self.at += digits.len();
        digits.parse().expect("a number")
    }

    /// A name, or a function with what it is taken of.
    fn word(&mut self) -> f64 {
        let rest = &self.text[self.at..];
        let word: String = rest.iter().take_while(|c| c.is_ascii_alphanumeric()).collect();
        self.at += word.len();
        if let Some((_, value)) = POINT.iter().find(|(known, _)| *known == word) {
            return *value;
        }
        let exponent = self.superscript();
        let mut arguments = Vec::new();
        if self.take(" ") {
            // After a bare argument nothing may follow that could belong to it.
            arguments.push(self.word());
            let next: String = self.text[self.at..].iter().take(4).collect();
            let free = ["", " + ", " − ", " sin", " exp", ")", "|", ", "];
            let ends =
                free.iter().any(|end| if end.is_empty() { next.is_empty() } else { next.starts_with(end) });
            assert!(ends, "«{word} …» before «{next}»");
        } else {
            self.expect("(");
            arguments.push(self.sum());
            while self.take(", ") {
                arguments.push(self.sum());
            }
            self.expect(")");
        }
        let value = apply(&word, &arguments);
        exponent.map_or(value, |exponent| value.powf(exponent))
    }
}

/// Braces pair up, and every `\left` has its `\right`.
#[track_caller]
pub(super) fn assert_balanced(latex: &str) {
    let mut depth = 0_i32;
    let mut escaped = false;
    for sign in latex.chars() {
        match sign {
            '{' if !escaped => depth += 1,
            '}' if !escaped => depth -= 1,
            _ => {}
        }
        assert!(depth >= 0, "{latex}");
        escaped = sign == '\\' && !escaped;
    }
    assert_eq!(depth, 0, "{latex}");
    assert_eq!(latex.matches(r"\left").count(), latex.matches(r"\right").count(), "{latex}");
    assert!(!latex.contains(['−', '·', '√', '×', '∂', '′']), "a sign of the other notation: {latex}");
}
