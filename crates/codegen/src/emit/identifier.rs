//! Names as programs may have them, and text that stays inside a comment.

/// Words that are no names in one of the languages.
const KEYWORDS: &[&str] = &[
    "abstract", "and", "as", "assert", "async", "auto", "await", "become", "box", "break", "case", "char", "class",
    "const", "continue", "crate", "def", "default", "del", "do", "double", "dyn", "elif", "else", "enum", "except",
    "extern", "false", "final", "finally", "float", "fn", "for", "from", "gen", "global", "goto", "if", "impl",
    "import", "in", "inline", "int", "is", "lambda", "let", "long", "loop", "macro", "match", "mod", "move", "mut",
    "nonlocal", "not", "np", "or", "override", "pass", "priv", "pub", "raise", "ref", "register", "restrict", "return",
    "self", "short", "signed", "sizeof", "static", "struct", "super", "switch", "trait", "true", "try", "type",
    "typedef", "typeof", "union", "unsafe", "unsigned", "unsized", "use", "virtual", "void", "volatile", "where",
    "while", "with", "yield",
];

/// A name of letters, digits and underscores that is no word of a language.
pub(super) fn identifier(name: &str) -> String {
    let mut text: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if text.is_empty() || text.starts_with(|c: char| c.is_ascii_digit()) {
        text.insert(0, 'x');
    }
    if KEYWORDS.contains(&text.as_str()) {
        text.push('_');
    }
    text
}

/// Text for one line of a comment in any of the languages.
pub(super) fn comment(text: &str) -> String {
    let steers = |c: char| c.is_control() || matches!(c, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let line: String = text.chars().map(|c| if steers(c) { ' ' } else { c }).collect();
    line.replace("*/", "* /").replace("/*", "/ *").replace("\"\"\"", "'''").replace('\\', "/")
}
