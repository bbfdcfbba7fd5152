//! What generated files say of themselves.

use super::cases::arm;
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{Head, Language, Precision, files};

#[test]
fn every_file_says_what_it_is_of_and_what_it_costs() {
    let case = arm(Fidelity::ALL[0]);
    let head = Head { robot: "Arm 7".to_owned(), model: "complete".to_owned(), command: "gyroflex codegen".to_owned() };
    for language in Language::ALL {
        for file in files(*language, &head, &case.functions, Precision::Double, "arm") {
            let said = |what: &str| assert!(file.text.contains(what), "{} does not say `{what}`", file.name);
            ["Arm 7", "complete", "gyroflex codegen", env!("CARGO_PKG_VERSION")].into_iter().for_each(said);
            for function in &case.functions {
                said(&function.name);
                said(&function.operations().multiplications.to_string());
                said(&function.depth().to_string());
            }
        }
    }
}

/// The marks that end a comment do not, wherever a robot's name has them.
#[test]
fn names_stay_inside_comments() {
    let case = arm(Fidelity::ALL[0]);
    let name = "a */ b\n\"\"\" c\u{2028}d\\";
    let head = Head { robot: name.to_owned(), model: name.to_owned(), command: name.to_owned() };
    for language in [Language::Rust, Language::C, Language::Python] {
        for file in files(language, &head, &case.functions, Precision::Double, "arm") {
            let plain = Head { robot: "a".to_owned(), model: "a".to_owned(), command: "a".to_owned() };
            let like = files(language, &plain, &case.functions, Precision::Double, "arm");
            let like = like.iter().find(|f| f.name == file.name).expect("the same files");
            for mark in ["*/", "\"\"\"", "\n", "\u{2028}", "\\"] {
                let count = |text: &str| text.matches(mark).count();
                assert_eq!(count(&file.text), count(&like.text), "{}: {mark:?}", file.name);
            }
        }
    }
}

#[test]
fn languages_are_found_by_their_names() {
    for language in Language::ALL {
        assert_eq!(Language::named(language.name()), Some(*language));
    }
    assert_eq!(Language::named("fortran"), None);
}
