//! Small robots with feet, and short ways to let them move.

use gyroflex_sim::contact::{Event, EventKind};
use gyroflex_sim::load::{LoadOptions, load_urdf_text};
use gyroflex_sim::record::{MemoryRecorder, Sample};
use gyroflex_sim::{Error, Robot, ScenarioFile, Simulation, Summary};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

/// Gravity [m/s²].
pub const G: f64 = 9.81;

/// A robot of URDF and YAML.
pub fn try_robot(urdf: &str, yaml: &str) -> Result<Robot, Error> {
    load_urdf_text(urdf, "test.urdf", Some(&format!("urdf: test.urdf\n{yaml}")), &LoadOptions::default())
}

/// The same, where nothing is wrong.
pub fn robot(urdf: &str, yaml: &str) -> Robot {
    try_robot(urdf, yaml).unwrap_or_else(|e| panic!("{e}"))
}

/// A link with its mass [kg], centre of mass [m] and moment of inertia about every axis [kg m²].
pub fn link(name: &str, mass: f64, [x, y, z]: [f64; 3], inertia: f64) -> String {
    format!(
        "<link name=\"{name}\"><inertial><origin xyz=\"{x} {y} {z}\"/><mass value=\"{mass}\"/>\
         <inertia ixx=\"{inertia}\" iyy=\"{inertia}\" izz=\"{inertia}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
    )
}

/// A joint at `xyz` of its parent [m].
pub fn joint(name: &str, kind: &str, [parent, child]: [&str; 2], [x, y, z]: [f64; 3], axis: &str) -> String {
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
         <origin xyz=\"{x} {y} {z}\"/><axis xyz=\"{axis}\"/>\
         <limit lower=\"-1e3\" upper=\"1e3\" effort=\"1e4\" velocity=\"1e4\"/></joint>"
    )
}

/// A point mass of 2 kg that slides along x and z, `foot` for its contact.
pub fn point() -> Robot {
    let urdf = [
        "<robot name=\"point\"><link name=\"world\"/><link name=\"across\"/>".to_owned(),
        joint("x", "prismatic", ["world", "across"], [0.0; 3], "1 0 0"),
        joint("z", "prismatic", ["across", "ball"], [0.0; 3], "0 0 1"),
        link("ball", 2.0, [0.0; 3], 1e-3),
        "</robot>".to_owned(),
    ];
    robot(&urdf.concat(), "contacts: {foot: {link: ball}}")
}

/// A free body of 12 kg on legs: points under its centre of mass at the places given [m].
pub fn table(feet: &[[f64; 3]], more: &str) -> Robot {
    let mut yaml = "floating: true\ncontacts:\n".to_owned();
    for (i, [x, y, z]) in feet.iter().enumerate() {
        let _ = writeln!(yaml, "  foot{i}: {{link: table, point: [{x}, {y}, {z}]}}");
    }
    yaml.push_str(more);
    robot(&format!("<robot name=\"table\">{}</robot>", link("table", 12.0, [0.0; 3], 0.3)), &yaml)
}

/// The scenario of some YAML, for whatever robot.
pub fn scenario(yaml: &str) -> ScenarioFile {
    ScenarioFile::parse(&format!("robot: robot.yaml\n{yaml}"), Path::new("test.yaml")).unwrap_or_else(|e| panic!("{e}"))
}

/// What came of a run.
pub struct Run {
    pub summary: Summary,
    pub samples: Vec<Sample>,
    pub simulation: Simulation,
}

impl Run {
    /// Times of all events of a kind [s].
    pub fn times(&self, kind: EventKind) -> Vec<f64> {
        self.events(kind).map(|e| e.t).collect()
    }

    /// All events of a kind.
    pub fn events(&self, kind: EventKind) -> impl Iterator<Item = &Event> {
        self.simulation.events().iter().filter(move |e| e.kind == kind)
    }

    /// The last sample.
    pub fn last(&self) -> &Sample {
        self.samples.last().expect("a run has samples")
    }
}

/// Runs to the end and keeps everything.
pub fn run(robot: &Robot, yaml: &str) -> Run {
    let mut simulation = Simulation::new(robot, &scenario(yaml)).unwrap_or_else(|e| panic!("{e}"));
    let mut memory = MemoryRecorder::new(simulation.run_info());
    let summary = simulation.run(&mut memory, &mut |_| ControlFlow::Continue(())).unwrap_or_else(|e| panic!("{e}"));
    Run { summary, samples: memory.samples().to_vec(), simulation }
}

/// The energy of motion and height [J].
pub fn energy(sample: &Sample) -> f64 {
    sample.kinetic_energy + sample.gravity_energy + sample.elastic_energy
}

/// Asserts that two numbers are within a distance.
#[track_caller]
pub fn close(what: &str, found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{what}: {found} instead of {expected}, {:.2e} off", found - expected);
}
