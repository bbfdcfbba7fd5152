//! Laws of explicit equations as a document.

mod arms;

use arms::{Arm, shipped};
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{File, Head, latex};
use gyroflex_codegen::explicit::{ExplicitModel, Options};

fn document(arm: &Arm) -> File {
    let model = ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit");
    let head = Head {
        robot: arm.name.clone(),
        model: arm.fidelity.name().to_owned(),
        command: format!("gyroflex codegen {}/robot.yaml --language latex", arm.name),
    };
    latex::document(&model, &head)
}

/// Writes the documents of the project's robots where `GYROFLEX_LATEX` says, to be looked at.
#[test]
#[ignore = "writes files"]
fn write() {
    let folder = std::env::var("GYROFLEX_LATEX").expect("a folder");
    let mut elastic = shipped::two_link(true);
    elastic.name = "book_two_link_elastic".to_owned();
    let mut reflected = shipped::planar_2r(Fidelity::RigidReflected);
    reflected.name = "planar_2r_rigid".to_owned();
    for arm in [
        shipped::planar_2r(Fidelity::Complete),
        reflected,
        shipped::two_link(false),
        elastic,
        shipped::puma560(Fidelity::Complete, 1.0),
    ] {
        let file = document(&arm);
        std::fs::write(format!("{folder}/{}", file.name), file.text).expect("the folder is there");
    }
}
