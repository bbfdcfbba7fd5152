//! Sums in modal coordinates that stand in several places get a name.

use std::collections::BTreeMap;

/// Replaces sums in brackets that hold modal coordinates, but no velocities, by `u_k` where they stand more than once; what they are.
pub(super) fn abbreviate(equations: &mut [&mut String]) -> Vec<(String, String)> {
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    for equation in &*equations {
        for group in groups(equation) {
            *uses.entry(group.to_owned()).or_default() += 1;
        }
    }
    let mut named: Vec<(String, String)> = Vec::new();
    for equation in equations {
        let repeated: Vec<String> = groups(equation).into_iter().filter(|g| uses[*g] > 1).map(str::to_owned).collect();
        for group in repeated {
            let place = named.iter().position(|(_, sum)| *sum == group).unwrap_or_else(|| {
                named.push((format!("u_{{{}}}", named.len() + 1), group.clone()));
                named.len() - 1
            });
            **equation = equation.replace(&format!("({group})"), &named[place].0);
        }
    }
    named
}

/// The innermost brackets of such sums, without the brackets.
fn groups(equation: &str) -> Vec<&str> {
    let mut out = Vec::new();
    let mut open = None;
    for (at, c) in equation.char_indices() {
        match c {
            '(' => open = Some(at + 1),
            ')' => {
                let inside = open.take().map(|from| &equation[from..at]);
                out.extend(inside.filter(|sum| sum.contains("\\eta") && !sum.contains("dot")));
            }
            _ => {}
        }
    }
    out
}
