//! MathML Core, which browsers show without a script.

use super::parts::{Spelling, WIDE, greek, script};

pub(crate) struct MathMl;

/// Invisible operator between a function and its argument, for screen readers.
const APPLIED: &str = "<mo>\u{2061}</mo>";
/// Invisible multiplication sign between factors, for screen readers.
const TIMES: &str = "<mo>\u{2062}</mo>";
const SPACE: &str = "<mspace width=\".17em\"></mspace>";
const TIMES_AND_SPACE: &str = "<mo>\u{2062}</mo><mspace width=\".17em\"></mspace>";

impl Spelling for MathMl {
    fn width(&self, text: &str) -> f64 {
        let is_seen = |sign: &char| !matches!(sign, '\u{2061}' | '\u{2062}');
        let signs = text.split('<').filter_map(|part| part.split_once('>'));
        5.6 * signs.flat_map(|(_, sign)| sign.chars()).filter(is_seen).count() as f64
    }

    fn is_tall(&self, inner: &str) -> bool {
        ["<mfrac>", "<msqrt>", "<munderover>", "<mtable>"].iter().any(|tall| inner.contains(tall))
    }

    fn nesting(&self, rest: &str) -> i32 {
        i32::from(rest.starts_with('<')) - 2 * i32::from(rest.starts_with("</"))
    }

    fn is_applied(&self, before: &str) -> bool {
        before.rsplit_once('<').is_some_and(|(before, _)| before.ends_with(APPLIED))
    }

    fn sign(&self, sign: &str) -> String {
        match (sign, sign.trim()) {
            ("λ" | "π", letter) => format!("<mi>{letter}</mi>"),
            ("−", _) => "<mo form=\"prefix\">−</mo>".to_owned(),
            ("\u{2009}", _) => SPACE.to_owned(),
            ("d/dt ", _) => fraction("<mi>d</mi>", "<mrow><mi>d</mi><mi>t</mi></mrow>") + SPACE,
            (_, "+" | "−" | "=") => format!("<mo form=\"infix\">{}</mo>", sign.trim()),
            (_, sign) => format!("<mo>{sign}</mo>"),
        }
    }

    fn digits(&self, digits: &str) -> String {
        format!("<mn>{digits}</mn>")
    }

    fn small_fraction(&self, above: i128, below: i128) -> String {
        format!("<mfrac displaystyle=\"false\"><mn>{above}</mn><mn>{below}</mn></mfrac>")
    }

    fn letter(&self, name: &str, is_array: bool) -> String {
        let letters = greek(name).map_or(name, |(_, greek)| greek);
        let letters: String = if is_array { letters.chars().map(bold).collect() } else { letters.to_owned() };
        // Capital Greek letters are upright, as in LaTeX.
        let is_upright = letters.chars().all(|letter| ('Α'..='Ω').contains(&letter));
        let variant = if is_upright { " mathvariant=\"normal\"" } else { "" };
        format!("<mi{variant}>{}</mi>", letters.replace('_', "\u{a0}"))
    }

    fn word(&self, word: &str) -> String {
        format!("<mtext>{word}</mtext>")
    }

    fn function(&self, name: &str) -> String {
        format!("<mi>{}</mi>", name.replace('_', "\u{a0}"))
    }

    fn dotted(&self, letter: String, dots: usize) -> String {
        match dots {
            0 => letter,
            _ => format!("<mover accent=\"true\">{letter}<mo>{}</mo></mover>", ["˙", "¨"][(dots - 1).min(1)]),
        }
    }

    fn indexed(&self, letter: String, below: &[String], indices: &[String]) -> String {
        let all = [below, indices].concat().join("<mo>,</mo>");
        if all.is_empty() { letter } else { format!("<msub>{}{}</msub>", whole(&letter), whole(&all)) }
    }

    fn power(&self, base: &str, exponent: &str) -> String {
        // The exponent goes above an existing subscript, not after it.
        if let Some(parts) = whole(base).strip_prefix("<msub>").and_then(|rest| rest.strip_suffix("</msub>"))
        {
            return format!("<msubsup>{parts}{}</msubsup>", whole(exponent));
        }
        format!("<msup>{}{}</msup>", whole(base), whole(exponent))
    }

    fn transposed(&self, matrix: &str) -> String {
        self.power(matrix, "<mi mathvariant=\"normal\">T</mi>")
    }

    fn primes(&self, function: &str, order: usize) -> String {
        let primes = "<mo>′</mo>".repeat(order);
        self.power(function, &primes)
    }

    fn root(&self, inner: &str) -> String {
        format!("<msqrt>{inner}</msqrt>")
    }

    fn fraction(&self, above: &str, below: &str) -> String {
        fraction(&whole(above), &whole(below))
    }

    fn between(&self, [open, close]: [&str; 2], inner: &str, is_tall: bool) -> String {
        // On a line that may break, stretchy brackets grow with all content beside them, so low ones must not stretch.
        let stretchy = if is_tall { "" } else { " stretchy=\"false\"" };
        let (open, close) = (
            format!("<mo form=\"prefix\"{stretchy}>{open}</mo>"),
            format!("<mo form=\"postfix\"{stretchy}>{close}</mo>"),
        );
        // No line may break between bars.
        let is_whole = is_tall && self.width(inner) < WIDE || open.contains('|');
        if is_whole { format!("<mrow>{open}{inner}{close}</mrow>") } else { open + inner + &close }
    }

    fn matrix(&self, rows: &[Vec<String>]) -> String {
        let row = |row: &Vec<String>| {
            let entries: String = row.iter().map(|entry| format!("<mtd>{entry}</mtd>")).collect();
            format!("<mtr>{entries}</mtr>")
        };
        let rows: String = rows.iter().map(row).collect();
        self.between(["[", "]"], &format!("<mtable>{rows}</mtable>"), true)
    }

    fn applied(&self, function: &str, argument: &str, is_bare: bool) -> String {
        format!("{function}{APPLIED}{}{argument}", if is_bare { SPACE } else { "" })
    }

    fn differential(&self, order: usize, of: &str) -> String {
        let sign = "<mi>∂</mi>";
        let sign =
            if order == 1 { sign.to_owned() } else { self.power(sign, &self.digits(&order.to_string())) };
        sign + of
    }

    fn sum_over(&self, index: &str, from: &str, last: &str, body: &str) -> String {
        let (first, last) = (whole(&format!("{index}<mo>=</mo>{from}")), whole(last));
        format!("<munderover><mo>∑</mo>{first}{last}</munderover>{body}")
    }

    fn sum_where(&self, condition: &str, body: &str) -> String {
        format!("<munder><mo>∑</mo>{}</munder>{body}", whole(condition))
    }

    fn between_words(&self) -> &'static str {
        TIMES_AND_SPACE
    }

    fn beside(&self, before: &str, after: &str) -> &'static str {
        let after = ["<msup>", "<msubsup>", "<msub>", "<mrow>"]
            .iter()
            .fold(after, |rest, tag| rest.trim_start_matches(tag));
        let begins_with_word = after.strip_prefix("<mi>").is_some_and(is_word);
        let ends_with_word = before.rsplit_once("<mi>").is_some_and(|(_, last)| is_word(last));
        match after.starts_with("<mn>") {
            true => "<mo>·</mo>",
            false if begins_with_word || ends_with_word => self.between_words(),
            false => TIMES,
        }
    }
}

/// Returns whether the text before the end of an element is longer than one letter.
fn is_word(rest: &str) -> bool {
    rest.chars().take_while(|sign| *sign != '<').count() > 1
}

/// A fraction of two single elements.
fn fraction(above: &str, below: &str) -> String {
    format!("<mfrac>{above}{below}</mfrac>")
}

/// Wraps several elements into one.
fn whole(text: &str) -> String {
    let (mut depth, mut count) = (0, 0);
    for (place, _) in text.match_indices('<') {
        count += i32::from(depth == 0);
        depth += MathMl.nesting(&text[place..]);
    }
    if count == 1 { text.to_owned() } else { format!("<mrow>{text}</mrow>") }
}

/// Bold letter of Unicode for vectors and matrices.
fn bold(letter: char) -> char {
    let among = |first: char, of: char| char::from_u32(of as u32 + (letter as u32 - first as u32));
    let found = match letter {
        'A'..='Z' => among('A', '𝐀'),
        'a'..='z' => among('a', '𝐚'),
        'Α'..='Ω' => among('Α', '𝚨'),
        'α'..='ω' => among('α', '𝛂'),
        _ => script(letter.encode_utf8(&mut [0; 4]))
            .and_then(|capital| char::from_u32('𝓐' as u32 + capital as u32 - 'A' as u32)),
    };
    found.unwrap_or(letter)
}
