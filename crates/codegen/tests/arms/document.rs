//! Equations of a document read again, and evaluated.

use std::collections::HashMap;

/// The equations `left = right` of a document, lines put together.
pub fn equations(text: &str) -> Vec<(String, String)> {
    let mut out = Vec::new();
    for block in text.split("\\begin{align*}").skip(1) {
        let block = block.split("\\end{align*}").next().expect("it ends");
        for row in block.replace("\\\\\n &\\quad ", "").split("\\\\\n") {
            for one in row.split(",\\quad ") {
                if let Some((left, right)) = one.split_once('=') {
                    let name = left.replace(['&', ' ', '\n'], "");
                    out.push((name, right.trim().to_owned()));
                }
            }
        }
    }
    out
}

/// An entry of a matrix that stands as one.
pub fn entry(matrix: &str, i: usize, j: usize) -> &str {
    let inside = matrix.trim_start_matches("\\begin{bmatrix}").trim_end_matches("\\end{bmatrix}");
    inside.split("\\\\").nth(i).and_then(|row| row.split('&').nth(j)).expect("it has the entry").trim()
}

/// The table of constants.
pub fn constants(text: &str) -> HashMap<String, f64> {
    let Some((_, table)) = text.split_once("\\section*{Constants}") else { return HashMap::new() };
    let mut out = HashMap::new();
    for entry in table.split("\\mbox{$").skip(1) {
        let entry = entry.split("$}").next().expect("it ends");
        let (name, value) = entry.split_once(" = ").expect("a value");
        let value = value.split("\\ ").next().expect("a number");
        let value = match value.split_once("\\cdot 10^{") {
            Some((mantissa, power)) => format!("{mantissa}e{}", power.trim_end_matches('}')),
            None => value.to_owned(),
        };
        out.insert(name.to_owned(), value.parse().expect("a number"));
    }
    out
}

/// Evaluates an expression; `value` knows the symbols, by their text without spaces.
pub fn evaluate(text: &str, value: &dyn Fn(&str) -> f64) -> f64 {
    let text = text.replace("{-}", "-").replace("{+}", "+");
    let tokens: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
    let mut reader = Reader { tokens, at: 0, value };
    let result = reader.sum();
    assert_eq!(reader.at, reader.tokens.len(), "`{text}` is read to its end");
    result
}

struct Reader<'a> {
    tokens: Vec<char>,
    at: usize,
    value: &'a dyn Fn(&str) -> f64,
}

impl Reader<'_> {
    fn peek(&self) -> Option<char> {
        self.tokens.get(self.at).copied()
    }

    fn take(&mut self) -> char {
        self.at += 1;
        self.tokens[self.at - 1]
    }

    fn sum(&mut self) -> f64 {
        let mut total = 0.0;
        loop {
            let negative = match self.peek() {
                Some('-') => {
                    self.take();
                    true
                }
                Some('+') => {
                    self.take();
                    false
                }
                _ => false,
            };
            let product = self.product();
            total += if negative { -product } else { product };
            if !matches!(self.peek(), Some('+' | '-')) {
                return total;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut total = 1.0;
        while let Some(c) = self.peek() {
            if matches!(c, '+' | '-' | ')') {
                break;
            }
            total *= self.factor();
        }
        total
    }

    fn factor(&mut self) -> f64 {
        let c = self.peek().expect("a factor");
        let base = if c == '(' {
            self.take();
            let sum = self.sum();
            assert_eq!(self.take(), ')');
            sum
        } else if c.is_ascii_digit() {
            let mut number = String::new();
            while self.peek().is_some_and(|c| c.is_ascii_digit() || c == '.') {
                number.push(self.take());
            }
            number.parse().expect("a number")
        } else {
            let mut name = String::new();
            if c == '\\' {
                loop {
                    name.push(self.take());
                    match self.peek() {
                        Some('\\') if name == "\\dot" => {}
                        Some(c) if c.is_ascii_alphabetic() && name != "\\dot" => {}
                        _ => break,
                    }
                }
                if name == "\\dot" {
                    name.push(self.take());
                }
            } else {
                name.push(self.take());
            }
            if name == "\\tfrac" {
                let (a, b) = (self.braces(), self.braces());
                return a.parse::<f64>().expect("a number") / b.parse::<f64>().expect("a number");
            }
            if name == "\\cos" || name == "\\sin" {
                assert_eq!(self.take(), '(');
                let angle = self.sum();
                assert_eq!(self.take(), ')');
                return if name == "\\cos" { angle.cos() } else { angle.sin() };
            }
            if self.peek() == Some('_') {
                self.take();
                name = format!("{name}_{{{}}}", self.braces());
            }
            (self.value)(&name)
        };
        if self.peek() != Some('^') {
            return base;
        }
        self.take();
        let power = if self.peek() == Some('{') { self.braces() } else { self.take().to_string() };
        base.powi(power.parse().expect("a power"))
    }

    fn braces(&mut self) -> String {
        assert_eq!(self.take(), '{');
        let mut inside = String::new();
        loop {
            match self.take() {
                '}' => return inside,
                c => inside.push(c),
            }
        }
    }
}
