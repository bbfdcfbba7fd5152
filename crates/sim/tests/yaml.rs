//! Laws of the strict YAML reader.

use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::load::yaml;
use serde::Deserialize;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Outer {
    #[serde(default)]
    inner: Option<Inner>,
    #[serde(default)]
    list: Vec<Inner>,
    #[serde(default)]
    number: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Inner {
    stiffness: f64,
    #[serde(default)]
    damping: f64,
}

fn refuse(text: &str) -> Error {
    let e = yaml::parse::<Outer>(text, "f.yaml").expect_err("this must be refused");
    assert_eq!(e.kind, ErrorKind::Yaml, "{e}");
    assert!(e.file.starts_with("f.yaml"), "{e}");
    assert!(!e.problem.is_empty() && !e.remedy.is_empty(), "{e:?}");
    e
}

#[test]
fn values_and_the_lines_of_their_keys_are_read() {
    let y = yaml::parse::<Outer>("inner:\n  stiffness: 2\n  damping: 1.0e-3\nlist:\n  - {stiffness: 3}\n", "f.yaml")
        .unwrap();
    let inner = y.value.inner.unwrap();
    assert_eq!((inner.stiffness, inner.damping, y.value.list[0].stiffness, y.value.number), (2.0, 1e-3, 3.0, 0.0));
    assert_eq!(y.keys.locate("inner.damping"), "f.yaml:3");
    assert_eq!(y.keys.locate("list[0].stiffness"), "f.yaml:5");
    assert_eq!(y.keys.locate("inner.absent"), "f.yaml:1");
    assert_eq!(y.keys.locate("absent"), "f.yaml");
    assert!(y.keys.has("inner.stiffness") && !y.keys.has("inner.absent"));
}

#[test]
fn an_unknown_key_names_its_line_its_path_and_the_nearest_known_key() {
    let e = refuse("inner:\n  stifness: 2\n");
    assert_eq!((e.file.as_str(), e.element.as_str()), ("f.yaml:2", "inner.stifness"));
    assert!(e.remedy.contains("`stiffness`"), "{e}");
    let e = refuse("number: 1\ninnr: {}\n");
    assert_eq!(e.file, "f.yaml:2");
    assert!(e.remedy.contains("`inner`"), "{e}");
    let e = refuse("list:\n  - stiffness: 1\n  - stiffness: 1\n    dampin: 2\n");
    assert_eq!((e.file.as_str(), e.element.as_str()), ("f.yaml:4", "list[1].dampin"));
    assert!(e.remedy.contains("`damping`"), "{e}");
}

#[test]
fn what_is_not_a_mapping_is_refused() {
    for text in ["", "# nothing\n", "- a\n- b\n", "just words\n", "3.0\n", "true\n", "null\n"] {
        let e = refuse(text);
        assert!(e.problem.contains("must be a mapping"), "{text:?}: {e}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for number in [".nan", ".inf", "-.inf", ".NaN", "1e999", "nan", "inf", "NaN", "infinity"] {
        let e = refuse(&format!("inner:\n  stiffness: {number}\n"));
        assert_eq!((e.file.as_str(), e.element.as_str()), ("f.yaml:2", "inner.stiffness"), "{e}");
    }
}

#[test]
fn doubled_missing_and_mistyped_keys_are_refused() {
    assert_eq!(refuse("number: 1\nnumber: 2\n").file, "f.yaml:2");
    assert!(refuse("inner:\n  damping: 2\n").problem.contains("`stiffness`"));
    let e = refuse("inner:\n  stiffness: soft\n");
    assert_eq!((e.file.as_str(), e.element.as_str()), ("f.yaml:2", "inner.stiffness"), "{e}");
    refuse("inner: [1, 2]\n");
    refuse("inner: {stiffness: [1]}\n");
    refuse("inner:\n\tstiffness: 1\n");
    refuse("inner: {stiffness: 1\n");
    refuse("number: 1\n---\nnumber: 2\n");
    refuse("number: *nowhere\n");
}

#[test]
fn deep_nesting_and_swelling_aliases_end_in_an_error() {
    refuse(&"[".repeat(10_000));
    refuse(&format!("number: {}{}", "[".repeat(10_000), "]".repeat(10_000)));
    refuse(&"a: {".repeat(10_000));
    let block: String = (0..10_000).map(|i| format!("{}a:\n", " ".repeat(i))).collect();
    refuse(&block);
    let dashes = "- ".repeat(10_000);
    refuse(&format!("number:\n {dashes}1\n"));

    let mut laughs = String::from("a0: &a0 [lol, lol, lol, lol, lol, lol, lol, lol, lol]\n");
    for i in 1..12 {
        let nine = vec![format!("*a{}", i - 1); 9].join(", ");
        laughs += &format!("a{i}: &a{i} [{nine}]\n");
    }
    refuse(&laughs);
}
