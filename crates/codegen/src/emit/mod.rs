//! Programs as text: one language a folder, and what languages share.
//!
//! What is generated needs nothing but its language: no library, no mathematics of an operating system. Functions that hardware
//! does not have come with the code (`elementary.rs`).

mod body;
mod c;
mod elementary;
mod head;
mod identifier;
mod json;
pub mod latex;
mod literal;
mod python;
mod rust;
mod style;

pub use head::Head;
pub use style::{Precision, Style};

use crate::function::Function;

/// A language to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// Rust without `std` and without dependencies.
    Rust,
    /// C99 without a library.
    C,
    /// Python with NumPy.
    Python,
    /// The graph itself, as JSON.
    Json,
}

impl Language {
    /// All of them.
    pub const ALL: &[Self] = &[Self::Rust, Self::C, Self::Python, Self::Json];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rust => "rust",
            Self::C => "c",
            Self::Python => "python",
            Self::Json => "json",
        }
    }

    /// The language of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|language| language.name() == name)
    }
}

/// A file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name, without folders.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// The files of some functions in a language; `stem` is the name of the files without what a language appends.
///
/// Matrices are arrays of rows in Rust and Python, and one array, row after row, in C. Python code computes in the type of its
/// arrays, and a graph has no type: of the style they take nothing.
pub fn files(
    language: Language,
    head: &Head,
    functions: &[Function],
    style: impl Into<Style>,
    stem: &str,
) -> Vec<File> {
    let style = style.into();
    match language {
        Language::Rust => rust::files(head, functions, style, stem),
        Language::C => c::files(head, functions, style, stem),
        Language::Python => python::files(head, functions, stem),
        Language::Json => json::files(head, functions, stem),
    }
}
