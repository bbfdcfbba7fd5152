//! Programs as text: one language a file.

pub mod latex;
mod literal;
mod rust;

use crate::function::Function;

/// A language to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// Rust without `std` and without dependencies.
    Rust,
}

/// The number type of generated code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Single.
    Single,
    /// Double.
    Double,
}

/// What a generated file says of itself.
#[derive(Clone, Debug)]
pub struct Head {
    /// The robot's name.
    pub robot: String,
    /// Which model of it.
    pub model: String,
    /// How the file is made again, as a command line.
    pub command: String,
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
pub fn files(language: Language, head: &Head, functions: &[Function], precision: Precision, stem: &str) -> Vec<File> {
    match language {
        Language::Rust => rust::files(head, functions, precision, stem),
    }
}
