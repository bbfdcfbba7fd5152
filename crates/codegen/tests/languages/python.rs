//! Python: batches through NumPy.

use super::cases::{SHIPPED, arm, mixed, shipped};
use super::toolchain::{Folder, numpy, run};
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{Language, Precision, files};

#[test]
fn batches_in_python_are_the_library() {
    if numpy().is_none() {
        println!("skipped: GYROFLEX_PYTHON_NUMPY names no interpreter");
        return;
    }
    let folder = Folder::new("python");
    folder.write("run.py", include_str!("run.py"));
    let mut cases = mixed(0..2);
    cases.push(arm(Fidelity::ALL[3]));
    cases.extend(SHIPPED.map(shipped));
    for case in &cases {
        for file in files(Language::Python, &case.head(), &case.functions, Precision::Double, &case.stem) {
            folder.write(&file.name, &file.text);
        }
        for (precision, dtype) in [(Precision::Double, "float64"), (Precision::Single, "float32")] {
            if precision == Precision::Single && case.stem.starts_with("mixed") {
                continue;
            }
            let (mut command, mut points) = (numpy().expect("it is there"), Vec::new());
            command.args(["run.py", &case.stem]);
            for (function, of_it) in case.functions.iter().zip(&case.points) {
                let lengths: Vec<String> = function.arguments.iter().map(|a| a.len.to_string()).collect();
                command.arg(format!("{}:{dtype}:{}:{}", function.name, of_it.inputs.len(), lengths.join(",")));
                points.extend(of_it.inputs.iter().cloned());
            }
            let got = run(&mut command, &folder, &points);
            let mut rest = got.as_slice();
            for (f, of_it) in case.points.iter().enumerate() {
                let (got, more) = rest.split_at(of_it.inputs.len());
                rest = more;
                case.assert_equal(&format!("Python, {dtype}"), f, precision, got);
            }
        }
    }
}
