//! The name a user probably meant.

/// The known name most like the given one, by the number of typing slips between them; `None` where nothing is known.
pub fn nearest<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = given.to_lowercase();
    known.into_iter().min_by_key(|name| strsim::damerau_levenshtein(&lower, &name.to_lowercase()))
}
