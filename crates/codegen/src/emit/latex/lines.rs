//! Long equations broken into lines.

/// Width of a line, in tenths of a letter.
pub(super) const LINE: usize = 960;

/// `left &= right`, broken before signs where a line is full: outside brackets, if the line is long enough there.
pub(super) fn equation(left: &str, right: &str) -> String {
    let begin = width(left) + 30;
    let mut lines: Vec<Vec<&str>> = vec![Vec::new()];
    let (mut used, mut depth) = (begin, 0_i32);
    // Where the line may be broken outside brackets, and how wide it is until there.
    let mut outside = None;
    for part in parts(right) {
        let more = width(part);
        let line = lines.last_mut().expect("there is a line");
        if depth == 0 && used > LINE / 2 {
            outside = Some((line.len(), used));
        }
        if used + more > LINE && !line.is_empty() {
            let (at, until) = outside.take().unwrap_or((line.len(), used));
            let rest = line.split_off(at);
            lines.push(rest);
            used = 60 + used - until;
        }
        lines.last_mut().expect("there is a line").push(part);
        used += more;
        depth += part.chars().map(|c| i32::from(c == '(') - i32::from(c == ')')).sum::<i32>();
    }
    let lines: Vec<String> = lines.iter().map(|line| line.concat()).collect();
    format!("{left} &= {}", lines.join("\\\\\n &\\quad "))
}

/// Several equations one below the other.
pub(super) fn aligned(equations: &[String]) -> String {
    if equations.is_empty() {
        String::new()
    } else {
        format!("\\begin{{align*}}\n{}\n\\end{{align*}}\n", equations.join("\\\\\n"))
    }
}

/// The rows of equations, short ones side by side.
pub(super) fn gathered(equations: &[(String, String)]) -> Vec<String> {
    let (mut rows, mut row, mut used) = (Vec::new(), Vec::new(), 0);
    for (left, right) in equations {
        let own = width(left) + width(right) + 70;
        let alone = own > LINE / 2;
        if (alone || used + own > LINE) && !row.is_empty() {
            rows.push(core::mem::take(&mut row).join(",\\quad "));
            used = 0;
        }
        if alone {
            rows.push(equation(left, right));
        } else {
            row.push(format!("{left} {}= {right}", if row.is_empty() { "&" } else { "" }));
            used += own;
        }
    }
    if !row.is_empty() {
        rows.push(row.join(",\\quad "));
    }
    rows
}

/// The pieces between which a line may end, each with its sign.
fn parts(text: &str) -> Vec<&str> {
    let mut out = Vec::new();
    let mut begin = 0;
    for (at, _) in
        text.match_indices(" + ").chain(text.match_indices(" - ")).collect::<std::collections::BTreeMap<_, _>>()
    {
        out.push(&text[begin..at]);
        begin = at;
    }
    out.push(&text[begin..]);
    out
}

/// About how wide it is, in tenths of a letter.
pub(super) fn width(text: &str) -> usize {
    let (mut width, mut small, mut depth) = (0, None, 0_usize);
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '{' => depth += 1,
            '}' => {
                depth = depth.saturating_sub(1);
                if small == Some(depth) {
                    small = None;
                }
            }
            '_' | '^' => {
                if chars.peek() == Some(&'{') {
                    small = small.or(Some(depth));
                } else {
                    chars.next();
                    width += 7;
                }
            }
            '\\' => {
                let mut name = String::new();
                while chars.peek().is_some_and(char::is_ascii_alphabetic) {
                    name.extend(chars.next());
                }
                width += match name.as_str() {
                    "dot" | "ddot" | "mathrm" | "mathit" | "" => 0,
                    "cos" | "sin" => 27,
                    "tfrac" => {
                        // Half of its digits, small.
                        small = small.or(Some(depth));
                        0
                    }
                    _ => 10,
                };
            }
            ' ' => width += 4,
            '+' | '-' | '=' => width += 14,
            '(' | ')' => width += 7,
            _ => width += if small.is_some() { 7 } else { 9 },
        }
    }
    width
}
