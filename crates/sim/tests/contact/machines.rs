//! Small machines as URDF text, and short ways to run them.

use gyroflex_sim::load::{LoadOptions, load_urdf_text};
use gyroflex_sim::record::{Impact, MemoryRecorder, Sample};
use gyroflex_sim::{Error, Robot, ScenarioFile, Simulation, Summary};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;

/// Acceleration of gravity [m/s²].
pub const G: f64 = 9.81;
/// Mass of every machine that has only one [kg].
pub const MASS: f64 = 2.0;

/// A joint of a chain: name, URDF type, axis, and the inertial part of its link; links are called `<joint>_link`, the root `base`.
pub type Part<'a> = (&'a str, &'a str, &'a str, String);

/// An inertial part: mass, place along x and z, moment of inertia about y.
pub fn inertial(mass: f64, x: f64, z: f64, about_y: f64) -> String {
    // The other moments do not move in a plane; they make the triangle inequality hold.
    let other = about_y.max(1e-3);
    format!(
        "<inertial><origin xyz=\"{x} 0 {z}\"/><mass value=\"{mass}\"/>
         <inertia ixx=\"{other}\" iyy=\"{about_y}\" izz=\"{other}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"
    )
}

/// Parts in a chain, each on the one before, or all on the base.
fn urdf(parts: &[Part], chain: bool) -> String {
    let mut text = "<robot name=\"machine\"><link name=\"base\"/>".to_owned();
    let mut parent = "base".to_owned();
    for (name, kind, axis, inertial) in parts {
        let limit = "<limit lower=\"-100\" upper=\"100\" effort=\"1e6\" velocity=\"1e6\"/>";
        write!(
            text,
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{name}_link\"/>
             <axis xyz=\"{axis}\"/>{limit}</joint><link name=\"{name}_link\">{inertial}</link>"
        )
        .expect("a string takes all");
        if chain {
            parent = format!("{name}_link");
        }
    }
    text + "</robot>"
}

pub fn try_load(urdf: &str, yaml: &str) -> Result<Robot, Error> {
    load_urdf_text(urdf, "machine.urdf", Some(&format!("urdf: machine.urdf\n{yaml}")), &LoadOptions::default())
}

pub fn chain(parts: &[Part], yaml: &str) -> Robot {
    try_load(&urdf(parts, true), yaml).unwrap_or_else(|e| panic!("{e}"))
}

pub fn side_by_side(parts: &[Part], yaml: &str) -> Robot {
    try_load(&urdf(parts, false), yaml).unwrap_or_else(|e| panic!("{e}"))
}

/// URDF of a mass that moves along x, y and z.
pub fn mass_urdf() -> String {
    let none = String::new;
    let parts = [
        ("x", "prismatic", "1 0 0", none()),
        ("across", "prismatic", "0 1 0", none()),
        ("z", "prismatic", "0 0 1", inertial(MASS, 0.0, 0.0, 0.01)),
    ];
    urdf(&parts, true)
}

/// A mass that moves along x, y and z, and touches the ground in one point.
pub fn mass() -> Robot {
    try_load(&mass_urdf(), "contacts: {foot: {link: z_link}}\n").unwrap_or_else(|e| panic!("{e}"))
}

/// Half the length of the rod [m], and its moment of inertia about its middle [kg m²].
pub const HALF: f64 = 0.3;
pub const ABOUT_MIDDLE: f64 = MASS * HALF * HALF / 3.0;

/// A body that moves freely in the plane of x and z and turns about y.
pub fn planar(inertial: String, yaml: &str) -> Robot {
    let none = String::new;
    let parts = [
        ("x", "prismatic", "1 0 0", none()),
        ("z", "prismatic", "0 0 1", none()),
        ("pitch", "continuous", "0 1 0", inertial),
    ];
    chain(&parts, yaml)
}

/// A uniform rod in the plane that touches the ground with both ends.
pub fn rod() -> Robot {
    let contacts = format!(
        "contacts:\n  front: {{link: pitch_link, point: [{HALF}, 0, 0]}}\n  rear: {{link: pitch_link, point: [-{HALF}, 0, 0]}}\n"
    );
    planar(inertial(MASS, 0.0, 0.0, ABOUT_MIDDLE), &contacts)
}

pub fn scenario(yaml: &str) -> ScenarioFile {
    ScenarioFile::parse(&format!("robot: machine.yaml\n{yaml}"), Path::new("test.yaml"))
        .unwrap_or_else(|e| panic!("{e}"))
}

/// What a run left behind.
pub struct Run {
    pub summary: Summary,
    pub samples: Vec<Sample>,
    pub impacts: Vec<Impact>,
}

impl Run {
    pub fn last(&self) -> &Sample {
        self.samples.last().expect("a run has samples")
    }

    pub fn touch(&self, sample: &Sample, contact: &str) -> gyroflex_sim::record::Touch {
        let i = self.summary.contacts.iter().position(|c| c == contact).expect("the contact is known");
        sample.footing.as_ref().expect("something holds the robot").contacts[i]
    }
}

pub fn run(robot: &Robot, yaml: &str) -> Run {
    let mut simulation = Simulation::new(robot, &scenario(yaml)).unwrap_or_else(|e| panic!("{e}"));
    let mut memory = MemoryRecorder::new(simulation.run_info());
    let summary = simulation.run(&mut memory, &mut |_| ControlFlow::Continue(())).unwrap_or_else(|e| panic!("{e}"));
    Run { summary, samples: memory.samples().to_vec(), impacts: memory.impacts().to_vec() }
}

#[track_caller]
pub fn assert_near(what: &str, got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance, "{what}: {got} for {want}, {:.1e} apart", (got - want).abs());
}
