//! Robots whose descriptions can be changed by hand.

use gyroflex::model::{BodySpec, DriveSpec, Fidelity, RobotSpec, SpringSpec, TransmissionSpec};
use gyroflex::spatial::{SpatialInertia, SymMat3, Vec3};
use gyroflex_codegen::robot::Robot;
use gyroflex_testkit::Lowered;
use gyroflex_testkit::flexible::{BendingLink, LoweredFlexible, Seats};
use gyroflex_testkit::random::RandomRobot;

/// A description that can be changed by hand.
#[derive(Clone)]
pub struct Described {
    pub seed: u64,
    pub fidelity: Fidelity,
    pub bodies: Vec<BodySpec>,
    tables: Vec<[f64; 2]>,
    gravity: Vec3<f64>,
    payload: Option<(usize, SpatialInertia<f64>)>,
    bending: Option<(Vec<BendingLink>, Vec<Seats>)>,
    joints: Vec<String>,
    links: Vec<String>,
}

/// Its records.
pub struct Records {
    pub rigid: Lowered<f64>,
    pub bending: Option<LoweredFlexible<f64>>,
}

fn sum(a: SpatialInertia<f64>, b: SpatialInertia<f64>, factor: f64) -> SpatialInertia<f64> {
    a + b.map(|x| x * factor)
}

impl Described {
    /// With a load on the last link that does not bend.
    pub fn new(robot: &RandomRobot, fidelity: Fidelity, bending: Option<(Vec<BendingLink>, Vec<Seats>)>) -> Self {
        let names = |what: &str| (0..robot.bodies.len()).map(|i| format!("{what}{i}")).collect();
        let bends = |i: &usize| bending.as_ref().is_some_and(|(links, _)| links.iter().any(|link| link.body == *i));
        let mut bodies = robot.bodies.clone();
        let load = SpatialInertia::from_com(1.5, Vec3::new(0.05, -0.1, 0.2), SymMat3::diagonal(0.01, 0.015, 0.02));
        let payload = (0..bodies.len()).rev().find(|i| !bends(i)).map(|i| (i, load));
        if let Some((i, load)) = payload {
            bodies[i].inertia = bodies[i].inertia + load;
        }
        Self {
            seed: robot.seed,
            fidelity,
            bodies,
            tables: robot.spring_tables.clone(),
            gravity: robot.gravity,
            payload,
            bending,
            joints: names("joint"),
            links: names("link"),
        }
    }

    fn spec(&self) -> RobotSpec<'_> {
        RobotSpec { bodies: &self.bodies, spring_tables: &self.tables, gravity: self.gravity }
    }

    pub fn lower(&self) -> Records {
        let bend = |(links, seats): &(Vec<BendingLink>, Vec<Seats>)| {
            LoweredFlexible::new(&self.spec(), links, seats, self.fidelity).expect("the description is valid")
        };
        Records {
            rigid: Lowered::new(&self.spec(), self.fidelity).expect("the description is valid"),
            bending: self.bending.as_ref().map(bend),
        }
    }

    pub fn robot<'a>(&'a self, records: &'a Records) -> Robot<'a> {
        Robot {
            name: "random",
            joints: &self.joints,
            links: &self.links,
            spec: self.spec(),
            fidelity: self.fidelity,
            model: records.rigid.view(),
            flexible: records.bending.as_ref().map(LoweredFlexible::view),
            payload: self.payload,
        }
    }

    /// The same robot with one number changed where a user has it.
    pub fn change(&mut self, name: &str, value: f64) {
        if name == "gravity" {
            self.gravity = self.gravity.scale(value / self.gravity.norm());
            return;
        }
        let (of, key) = name.rsplit_once('.').expect("a parameter is of something");
        if of == "payload" {
            let (i, load) = self.payload.as_mut().expect("there is a load");
            let heavier = load.map(|x| x * value / load.mass);
            self.bodies[*i].inertia = sum(sum(self.bodies[*i].inertia, *load, -1.0), heavier, 1.0);
            *load = heavier;
            return;
        }
        if key == "mass" {
            let i = self.links.iter().position(|link| link == of).expect("the link is there");
            let load = self.payload.filter(|(on, _)| *on == i).map_or(SpatialInertia::zero(), |(_, load)| load);
            let own = sum(self.bodies[i].inertia, load, -1.0);
            let com = own.first_moment.scale(1.0 / own.mass);
            let point = |mass: f64| SpatialInertia::from_com(mass, com, SymMat3::zero());
            let about_com = sum(own, point(own.mass), -1.0).rotational;
            self.bodies[i].inertia = SpatialInertia::from_com(value, com, about_com) + load;
            return;
        }
        let i = self.joints.iter().position(|joint| joint == of).expect("the joint is there");
        let body = &mut self.bodies[i];
        if key == "viscous" {
            body.friction.viscous = value;
            return;
        }
        let DriveSpec { rotor, gear_ratio, transmission, friction } = body.drive.as_mut().expect("it is driven");
        match (key, transmission) {
            ("motor_viscous", _) => friction.viscous = value,
            ("gear_ratio", _) => *gear_ratio = value,
            ("rotor_inertia", _) => rotor.inertia = value,
            ("damping", TransmissionSpec::Elastic { damping, .. }) => *damping = value,
            ("stiffness", TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, .. }) => {
                *stiffness = value;
            }
            _ => panic!("nobody knows what {name} is"),
        }
    }
}

impl std::fmt::Display for Described {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "seed {}, {} bodies, model {}", self.seed, self.bodies.len(), self.fidelity.name())
    }
}
