//! Long equations broken into lines.

/// Signs of a line, as `width` counts them.
const LINE: usize = 118;

/// `left &= right`, broken before signs where a line is full.
pub(super) fn equation(left: &str, right: &str) -> String {
    let mut out = format!("{left} &= ");
    let mut used = width(left) + 3;
    for part in parts(right) {
        let more = width(part);
        if used + more > LINE && used > width(left) + 3 {
            out.push_str("\\\\\n &\\quad ");
            used = 6;
        }
        out.push_str(part);
        used += more;
    }
    out
}

/// Several equations one below the other.
pub(super) fn aligned(equations: &[String]) -> String {
    if equations.is_empty() {
        String::new()
    } else {
        format!("\\begin{{align*}}\n{}\n\\end{{align*}}\n", equations.join("\\\\\n"))
    }
}

/// Short equations side by side.
pub(super) fn gathered(equations: &[(String, String)]) -> String {
    let (mut rows, mut row, mut used) = (Vec::new(), Vec::new(), 0);
    let mut long = Vec::new();
    for (left, right) in equations {
        let own = width(left) + width(right) + 8;
        if own > LINE / 2 {
            if !row.is_empty() {
                long.push(format!("&{}", core::mem::take(&mut row).join(",\\quad ")));
                used = 0;
            }
            long.push(equation(left, right));
            continue;
        }
        if used + own > LINE && !row.is_empty() {
            long.push(format!("&{}", core::mem::take(&mut row).join(",\\quad ")));
            used = 0;
        }
        row.push(format!("{left} = {right}"));
        used += own;
    }
    if !row.is_empty() {
        long.push(format!("&{}", row.join(",\\quad ")));
    }
    rows.append(&mut long);
    aligned(&rows)
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

/// About how many letters wide it is: a command is one, an index half of one.
pub(super) fn width(text: &str) -> usize {
    let (mut twice, mut small, mut depth) = (0, None, 0_usize);
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
                    twice += 1;
                }
            }
            '\\' => {
                let mut name = String::new();
                while chars.peek().is_some_and(char::is_ascii_alphabetic) {
                    name.extend(chars.next());
                }
                twice += match name.as_str() {
                    "dot" | "ddot" | "mathrm" | "mathit" | "" => 0,
                    "cos" | "sin" => 6,
                    _ => 2,
                };
            }
            ' ' => twice += 1,
            _ => twice += if small.is_some() { 1 } else { 2 },
        }
    }
    twice / 2
}
