//! Robots from files.

use crate::Spec;
use gyroflex_sim::load::LoadOptions;
use std::path::Path;

/// A robot of `robots/`, its drives as in its YAML.
pub fn robot(name: &str) -> Spec {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots").join(name).join("robot.yaml"))
}

/// The robot of a YAML.
pub fn load(path: &Path) -> Spec {
    let robot = gyroflex_sim::load::load(path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    Spec { bodies: robot.bodies, spring_tables: robot.spring_tables, gravity: robot.gravity }
}
