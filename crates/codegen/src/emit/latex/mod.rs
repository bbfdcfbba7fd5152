//! The equations of motion as a document: explicit, in the grouping of Cetinkunt and Book 1988 (eq. 30, 38 and 46).
//!
//! Inertia, Coriolis and centrifugal forces, gravity, stiffness and damping, rotors, one section each. Coefficients are lumped constants
//! `p₁, p₂, …` with a table of their values at the end; parameters that are kept stand by their names.

mod abbreviations;
mod constants;
mod equations;
mod lines;
mod sections;
mod springs;
mod symbols;
mod terms;
mod velocities;

use super::{File, Head};
use crate::explicit::ExplicitModel;
use sections::Writer;

const PREAMBLE: &str = r"\documentclass[10pt,a4paper,fleqn]{article}
\usepackage[hmargin=16mm,vmargin=12mm]{geometry}
\usepackage{amsmath,multicol}
\allowdisplaybreaks
\setlength{\parindent}{0pt}
\setlength{\parskip}{2pt}
\setlength{\columnsep}{6pt}
\setlength{\mathindent}{1em}
\setlength{\multicolsep}{3pt}
\sloppy
\pagestyle{empty}
\makeatletter
\renewcommand{\section}{\@startsection{section}{1}{0pt}{5pt plus 2pt}{1pt}{\normalfont\normalsize\bfseries}}
\makeatother
";

/// After the size of the text, which sets its own.
const SPACING: &str = r"\abovedisplayskip=3pt plus 2pt \belowdisplayskip=3pt plus 2pt \abovedisplayshortskip=2pt \belowdisplayshortskip=3pt \jot=1pt
";

/// The document, `<robot>.tex`. It needs `amsmath`, `geometry` and `multicol`, which every distribution has.
pub fn document(model: &ExplicitModel, head: &Head) -> File {
    let (lumped, lumps) = model.lumped();
    let writer = Writer::new(model, &lumped);
    let body = writer.body(&lumps);
    let name = symbols::escaped(&head.robot);
    let text = format!(
        "% {}, {}. {}\n{PREAMBLE}\\begin{{document}}\\small\\raggedright\n{SPACING}{{\\Large Equations of motion of {name}}}\\par\n{}{body}\\end{{document}}\n",
        head.robot,
        head.model,
        head.command,
        writer.introduction(head),
    );
    let stem: String = head.robot.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    File { name: format!("{stem}.tex"), text }
}
