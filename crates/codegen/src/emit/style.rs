//! What may be chosen about generated code.

/// The number type of generated code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Precision {
    /// Single.
    Single,
    /// Double.
    Double,
}

/// Choices; those that a language knows nothing of change nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Style {
    /// The number type.
    pub precision: Precision,
    /// How many states a function of Rust takes side by side, as the lanes of a vector register; `None` is one, as plain numbers.
    pub lanes: Option<usize>,
}

impl From<Precision> for Style {
    /// Plain numbers of that precision.
    fn from(precision: Precision) -> Self {
        Self { precision, lanes: None }
    }
}
