//! Rust literals over several lines.
//!
//! The derived debug form of a record is its Rust literal, so that every field is there whatever the records become, and
//! `{:?}` of a number is the shortest form that reads back as the same bits. What is left to do is to break long lines.

/// Columns of a line.
const WIDTH: usize = 100;
const INDENT: usize = 4;

/// The literal over as many lines as it needs, the first one continuing a line that is `depth` steps indented.
pub(super) fn lay_out(literal: &str, depth: usize) -> String {
    let inner = fields(literal);
    if literal.len() + depth * INDENT <= WIDTH || inner.is_empty() {
        return literal.to_owned();
    }
    let start = literal.find(OPENING).unwrap_or(0) + 1;
    let margin = " ".repeat((depth + 1) * INDENT);
    let mut text = literal[..start].to_owned();
    for field in inner {
        text.push_str(&format!("\n{margin}{},", lay_out(field, depth + 1)));
    }
    text.push('\n');
    text.push_str(&" ".repeat(depth * INDENT));
    text.push_str(&literal[literal.len() - 1..]);
    text
}

const OPENING: [char; 3] = ['{', '[', '('];
const CLOSING: [char; 3] = ['}', ']', ')'];

/// The parts between the outermost brackets; none where there are no brackets.
pub(super) fn fields(literal: &str) -> Vec<&str> {
    let (Some(start), true) = (literal.find(OPENING), literal.ends_with(CLOSING)) else { return Vec::new() };
    let inner = &literal[start + 1..literal.len() - 1];
    let mut depth = 0_usize;
    let comma = |c: char| {
        depth += usize::from(OPENING.contains(&c));
        depth -= usize::from(CLOSING.contains(&c));
        c == ',' && depth == 0
    };
    inner.split(comma).map(str::trim).filter(|part| !part.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::{fields, lay_out};

    #[test]
    fn fields_are_split_at_the_outermost_commas() {
        assert_eq!(fields("A { x: [1.0, 2.0], y: Some(B { z: 3.0 }) }"), ["x: [1.0, 2.0]", "y: Some(B { z: 3.0 })"]);
        assert!(fields("x: 1.0").is_empty() && fields("[]").is_empty());
    }

    #[test]
    fn long_literals_are_broken_and_keep_their_words() {
        let vector = "Vec3 { x: 0.12345678, y: -0.12345678, z: 1e-9 }";
        let literal = format!("Body {{ parent: None, rows: [{vector}, {vector}, {vector}] }}");
        let text = lay_out(&literal, 1);
        assert!(text.lines().count() > 3 && text.lines().all(|l| l.len() <= 104), "{text}");
        let words = |t: &str| t.replace([',', '\n', ' '], "");
        assert_eq!(words(&text), words(&literal));
        assert_eq!(lay_out(vector, 1), vector);
    }
}
