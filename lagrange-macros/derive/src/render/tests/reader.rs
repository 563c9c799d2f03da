//! Reads formulas in Unicode as a person would, and rejects ambiguous ones.

use super::POINT;

/// A number (one entry) or a vector.
pub(super) type Value = Vec<f64>;

/// Values of the names in a text.
pub(super) trait Meanings {
    fn name(&self, name: &str) -> Option<Value>;

    /// f(…) or f′(…), given the numbers of all arguments in sequence.
    fn call(&self, function: &str, primes: usize, arguments: &[f64]) -> Value;

    /// ∂f/∂x∂y, at the formal arguments if none are given.
    fn partial(&self, function: &str, by: &[String], arguments: Option<&[f64]>) -> Value;

    /// Number of elements of the arrays that a sum over all others than one is about.
    fn elements(&self) -> i64 {
        panic!("no arrays here")
    }

    /// d/dt (∂f/∂x)
    fn rate_of_partial(&self, function: &str, by: &[String]) -> Value {
        panic!("no rate of ∂{function}/∂{by:?} here")
    }
}

/// Point at which the formulas of these tests are evaluated.
struct Point;

impl Meanings for Point {
    fn name(&self, name: &str) -> Option<Value> {
        POINT.iter().find(|(known, _)| *known == name).map(|(_, value)| vec![*value])
    }

    fn call(&self, function: &str, _: usize, arguments: &[f64]) -> Value {
        vec![apply(function, arguments)]
    }

    fn partial(&self, function: &str, _: &[String], _: Option<&[f64]>) -> Value {
        panic!("no derivatives of {function} here")
    }
}

/// Value of a text at [`POINT`].
pub(super) fn read(text: &str) -> f64 {
    number(read_with(text, &Point))
}

/// Value of a text, given the values of its names.
pub(super) fn read_with(text: &str, meanings: &dyn Meanings) -> Value {
    read_at(text, meanings, Vec::new())
}

/// The same for these values of running indices.
pub(super) fn read_at(text: &str, meanings: &dyn Meanings, indices: Vec<(String, i64)>) -> Value {
    let mut reader = Reader { text: text.chars().collect(), at: 0, meanings, indices };
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
        // Dot products of numbers, as if they were vectors of one component.
        ("dot", [x, y]) => x * y,
        ("atan2", [y, x]) => y.atan2(*x),
        ("f", [x, y]) => x - 2.0 * y,
        _ => panic!("no function {function} of {}", arguments.len()),
    }
}

#[track_caller]
fn number(value: Value) -> f64 {
    let [number] = value[..] else { panic!("a vector where a number is expected") };
    number
}

fn plus(x: &Value, y: &Value, sign: f64) -> Value {
    assert_eq!(x.len(), y.len(), "a sum of different shapes");
    x.iter().zip(y).map(|(x, y)| x + sign * y).collect()
}

/// Product of two values: at least one of them a number, a matrix of 3 by 3 and a vector or a matrix, or a quaternion and a vector.
fn times(x: &Value, y: &Value) -> Value {
    match (&x[..], &y[..]) {
        ([x], y) => y.iter().map(|y| x * y).collect(),
        (x, [y]) => x.iter().map(|x| x * y).collect(),
        (x, [_, _, _]) if x.len() == 9 => {
            x.chunks(3).map(|row| row.iter().zip(y).map(|(x, y)| x * y).sum()).collect()
        }
        (x, y) if x.len() == 9 && y.len() == 9 => {
            let entry = |i: usize, j: usize| (0..3).map(|k| x[3 * i + k] * y[3 * k + j]).sum();
            (0..9).map(|place| entry(place / 3, place % 3)).collect()
        }
        (&[w, x, y, z], &[a, b, c]) => {
            vec![-x * a - y * b - z * c, w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a]
        }
        _ => panic!("vectors side by side: {x:?} {y:?}"),
    }
}

fn dot(x: &Value, y: &Value) -> Value {
    assert_eq!(x.len(), y.len(), "a product of different shapes");
    vec![x.iter().zip(y).map(|(x, y)| x * y).sum()]
}

/// Power of a number, or the square of a vector.
fn raised(base: &Value, exponent: f64) -> Value {
    match base[..] {
        [number] => vec![number.powf(exponent)],
        _ => {
            assert!(exponent == 2.0, "a vector to the power {exponent}");
            dot(base, base)
        }
    }
}

fn cross(x: &Value, y: &Value) -> Value {
    let ([a, b, c], [d, e, f]) = (&x[..], &y[..]) else { panic!("a cross product of other lengths") };
    vec![b * f - c * e, c * d - a * f, a * e - b * d]
}

struct Reader<'a> {
    text: Vec<char>,
    at: usize,
    meanings: &'a dyn Meanings,
    /// Names and values of running indices.
    indices: Vec<(String, i64)>,
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

/// Names of mathematical functions.
const KNOWN: [&str; 12] =
    ["sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "ln", "abs"];

impl Reader<'_> {
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

    fn sum(&mut self) -> Value {
        let mut total = if self.take("−") { times(&vec![-1.0], &self.product()) } else { self.product() };
        loop {
            if self.take(" + ") {
                total = plus(&total, &self.product(), 1.0);
            } else if self.take(" − ") {
                total = plus(&total, &self.product(), -1.0);
            } else {
                return total;
            }
        }
    }

    /// Reads factors side by side, with a product of vectors as the last of them at most, or one fraction.
    fn product(&mut self) -> Value {
        let mut value = self.power();
        let mut before = vec![1.0];
        loop {
            if self.take(" · ") || (self.continues() && self.take(" ")) {
                before = times(&before, &value);
                value = self.power();
            } else if self.take("·") {
                return times(&before, &dot(&value, &self.power()));
            } else if self.take("×") {
                return times(&before, &cross(&value, &self.power()));
            } else if self.take("/") {
                let below = number(self.power());
                return times(&times(&before, &value), &vec![below.recip()]);
            } else {
                return times(&before, &value);
            }
        }
    }

    /// Returns whether a factor comes next instead of a sign.
    fn continues(&self) -> bool {
        self.peek() == Some(' ') && !matches!(self.text.get(self.at + 1), Some('+' | '−' | '·'))
    }

    fn power(&mut self) -> Value {
        let base = self.atom();
        let value = match self.superscript() {
            Some(exponent) => raised(&base, exponent),
            None if self.take("^") => raised(&base, number(self.atom())),
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

    /// Reads `Σ(i = 0 … 4) body` or `Σ(j ≠ i) body` after the sign: the body is a product.
    fn sum_over(&mut self) -> Value {
        self.expect("(");
        let name = self.letters();
        let values: Vec<i64> = if self.take(" = ") {
            let from = self.index();
            self.expect(" … ");
            (from..=self.index()).collect()
        } else {
            self.expect(" ≠ ");
            let other = self.index();
            (0..self.meanings.elements()).filter(|value| *value != other).collect()
        };
        self.expect(") ");
        let (start, mut total) = (self.at, None);
        // An empty sum is read once, to find its end.
        for value in values.iter().copied().chain(values.is_empty().then_some(0)) {
            self.at = start;
            self.indices.push((name.clone(), value));
            let term = self.product();
            self.indices.pop();
            total = Some(total.map_or_else(|| term.clone(), |total| plus(&total, &term, 1.0)));
        }
        let total = total.expect("a term");
        if values.is_empty() { vec![0.0; total.len()] } else { total }
    }

    fn letters(&mut self) -> String {
        let letters: String = self.text[self.at..].iter().take_while(|sign| sign.is_alphanumeric()).collect();
        self.at += letters.chars().count();
        letters
    }

    /// Reads a sum of running indices and whole numbers.
    fn index(&mut self) -> i64 {
        let mut sum = self.index_term();
        loop {
            if self.take(" + ") {
                sum += self.index_term();
            } else if self.take(" − ") {
                sum -= self.index_term();
            } else {
                return sum;
            }
        }
    }

    fn index_term(&mut self) -> i64 {
        let sign = if self.take("−") { -1 } else { 1 };
        let word = self.letters();
        let known = self.indices.iter().rev().find(|(name, _)| *name == word).map(|(_, value)| *value);
        sign * known.unwrap_or_else(|| word.parse().unwrap_or_else(|_| panic!("«{word}» is no index")))
    }

    fn atom(&mut self) -> Value {
        if self.take("Σ") {
            return self.sum_over();
        }
        if self.take("(") {
            if self.peek() == Some('∂') {
                return self.partial_in_parentheses();
            }
            let value = self.sum();
            self.expect(")");
            return self.component(value);
        }
        if self.take("d/dt ") {
            let is_enclosed = self.take("(");
            let (function, by) = self.partial();
            is_enclosed.then(|| self.expect(")"));
            return self.meanings.rate_of_partial(&function, &by);
        }
        if self.take("√") {
            return vec![number(self.atom()).sqrt()];
        }
        if self.take("|") {
            let value = self.sum();
            self.expect("|");
            return vec![value.iter().map(|x| x * x).sum::<f64>().sqrt()];
        }
        match self.peek() {
            Some('∂') => {
                let (function, by) = self.partial();
                self.meanings.partial(&function, &by, None)
            }
            Some('[') => self.list(),
            Some(first) if first.is_ascii_digit() => vec![self.digits_or_fraction()],
            Some(first) if first.is_alphabetic() => self.word(),
            Some(first) => {
                self.at += 1;
                let known = FRACTIONS.into_iter().find(|(sign, _)| *sign == first);
                vec![
                    known
                        .unwrap_or_else(|| {
                            panic!("«{first}» is no fraction in {}", self.text.iter().collect::<String>())
                        })
                        .1,
                ]
            }
            None => panic!("the text ends too early"),
        }
    }

    /// Reads the index of a component, as in `(A c)[0]`, or its subscript.
    fn component(&mut self, vector: Value) -> Value {
        let is_indexed = self.text.get(self.at + 1).is_some_and(char::is_ascii_digit);
        if !(is_indexed && matches!(self.peek(), Some('[' | '_'))) {
            return vector;
        }
        let has_brackets = self.peek() == Some('[');
        self.at += 1;
        let value = vec![vector[self.digits() as usize]];
        if has_brackets {
            self.expect("]");
        }
        value
    }

    /// Reads `∂²f/∂x∂y` without arguments: the function, and the variables of differentiation.
    fn partial(&mut self) -> (String, Vec<String>) {
        self.expect("∂");
        self.superscript();
        let function = self.name();
        self.expect("/");
        let mut by = Vec::new();
        while self.take("∂") {
            by.push(self.name());
        }
        (function, by)
    }

    /// Reads `(∂f/∂x)(a, b)` after its first parenthesis, or a product that begins with a derivative.
    fn partial_in_parentheses(&mut self) -> Value {
        let start = self.at;
        let (function, by) = self.partial();
        if !self.take(")") {
            self.at = start;
            let value = self.sum();
            self.expect(")");
            return value;
        }
        let arguments = self.take("(").then(|| self.arguments());
        self.meanings.partial(&function, &by, arguments.as_deref())
    }

    /// Reads all numbers up to the closing parenthesis.
    fn arguments(&mut self) -> Vec<f64> {
        let mut arguments = self.sum();
        while self.take(", ") {
            arguments.extend(self.sum());
        }
        self.expect(")");
        arguments
    }

    /// Reads `[a, b, c]`.
    fn list(&mut self) -> Value {
        self.expect("[");
        let mut items = self.sum();
        while self.take(", ") {
            items.extend(self.sum());
        }
        self.expect("]");
        items
    }

    /// Reads `12`, `9.81`, `10/7` or `6.6×10⁻³⁴`.
    fn digits_or_fraction(&mut self) -> f64 {
        let above = self.digits();
        let digit_follows = self.text.get(self.at + 1).is_some_and(char::is_ascii_digit);
        if digit_follows && self.take("×") {
            let ten = self.digits();
            return above * ten.powf(self.superscript().expect("an exponent"));
        }
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

    /// Reads a name with its indices and members.
    fn name(&mut self) -> String {
        let mut name = String::new();
        let mut is_in_index = false;
        while let Some(sign) = self.peek() {
            let is_running =
                sign == '[' && !self.text[self.at + 1..].first().is_some_and(char::is_ascii_digit);
            if is_running && !self.indices.is_empty() {
                self.at += 1;
                name += &format!("[{}]", self.index());
                self.expect("]");
                continue;
            }
            let next = self.text.get(self.at + 1).copied().unwrap_or(' ');
            let goes_on = match sign {
                '[' => next.is_ascii_digit(),
                ']' => is_in_index,
                '.' => next.is_alphabetic(),
                '\u{307}' | '\u{308}' | '_' => true,
                sign => {
                    sign.is_alphanumeric()
                        && !SUPERSCRIPTS.contains(sign)
                        && !FRACTIONS.iter().any(|(f, _)| *f == sign)
                }
            };
            if !goes_on {
                break;
            }
            is_in_index = is_in_index && sign != ']' || sign == '[';
            name.push(sign);
            self.at += 1;
        }
        name
    }

    /// Reads a name, or a function with its argument.
    fn word(&mut self) -> Value {
        let word = self.name();
        let is_called = matches!(self.peek(), Some('(' | '′'));
        if let Some((_, value)) = self.indices.iter().rev().find(|(name, _)| *name == word) {
            return vec![*value as f64];
        }
        if let Some(value) = self.meanings.name(&word).filter(|_| !is_called) {
            return value;
        }
        let exponent = self.superscript();
        let mut primes = 0;
        while self.take("′") {
            primes += 1;
        }
        let arguments = if KNOWN.contains(&&*word) && self.take(" ") {
            // Text after a bare argument must not be readable as part of it.
            let argument = self.word();
            let next: String = self.text[self.at..].iter().take(4).collect();
            let free = ["", " + ", " − ", " sin", " cos", " tan", " exp", ")", "|", ", ", "]"];
            let ends =
                free.iter().any(|end| if end.is_empty() { next.is_empty() } else { next.starts_with(end) });
            assert!(ends, "«{word} …» before «{next}»");
            argument
        } else {
            assert!(self.take("("), "what is «{word}»?");
            self.arguments()
        };
        let value = self.meanings.call(&word, primes, &arguments);
        match exponent {
            Some(exponent) => vec![number(value).powf(exponent)],
            None => value,
        }
    }
}

/// Asserts that braces pair up, and that every `\left` has its `\right`.
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
