//! Arms of any number of slender links that bend.

use crate::STATES;
use gyroflex::Scalar;
use gyroflex::dynamics::{
    Acceleration, External, FlexibleBody, FlexibleMode, FlexibleScratch, FlexibleStation, Forward, Inverse, State,
    flexible_aba, flexible_hybrid, flexible_matrix_len, flexible_rnea, flexible_shapes_len,
};
use gyroflex::model::{
    AssumedMode, Body, BodySpec, DriveSpec, Fidelity, FlexibleLink, FlexibleModel, FlexibleRecords, Friction,
    JointKind, ModePair, MountSpec, RobotSpec, RotorBody, RotorSpec, Seat, SpringSpec, Station, StationShape,
    TransmissionError, TransmissionSpec,
};
use gyroflex::spatial::{Mat3, Motion, SpatialInertia, SymMat3, Transform, Vec3};
use std::f64::consts::PI;

/// Points of the sums that stand for integrals over a link.
const POINTS: usize = 200;

/// What is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlexibleAlgorithm {
    /// [`flexible_aba`].
    Forward,
    /// [`flexible_rnea`].
    Inverse,
    /// [`flexible_hybrid`].
    Hybrid,
}

impl FlexibleAlgorithm {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Inverse => "inverse",
            Self::Hybrid => "hybrid",
        }
    }
}

/// A planar arm of uniform links of one metre and one kilogram, each bending in `modes` modes, with random states and storage for calls.
#[derive(Debug)]
pub struct Beams<T: Scalar + 'static> {
    model: FlexibleModel<'static, T::Param>,
    states: Vec<[Vec<T>; 5]>,
    bodies: Vec<FlexibleBody<T>>,
    stations: Vec<FlexibleStation<T>>,
    modes: Vec<FlexibleMode<T>>,
    shapes: Vec<Motion<T>>,
    matrix: Vec<T>,
    out: [Vec<T>; 4],
}

impl<T: Scalar + 'static> Beams<T> {
    /// `elastic` says that every joint is driven through a spring by a rotor at the end of the link before.
    pub fn new(links: usize, modes: usize, elastic: bool) -> Self {
        let model = arm(links, modes, elastic);
        let nv = model.nv();
        let states = (0..STATES).map(|s| core::array::from_fn(|k| vector(&model, s, k))).collect();
        Self {
            bodies: vec![FlexibleBody::new(); links],
            stations: vec![FlexibleStation::new(); model.stations().len()],
            modes: vec![FlexibleMode::new(); model.modes()],
            shapes: vec![Motion::zero(); flexible_shapes_len(&model)],
            matrix: vec![T::zero(); flexible_matrix_len(&model)],
            out: core::array::from_fn(|_| vec![T::zero(); nv]),
            states,
            model,
        }
    }

    /// One call, at one of the states.
    pub fn call(&mut self, algorithm: FlexibleAlgorithm, i: usize) {
        let [q, qd, theta, thetad, tau] = &self.states[i % STATES];
        let state = State { q, qd, theta, thetad };
        let scratch = FlexibleScratch {
            bodies: &mut self.bodies,
            stations: &mut self.stations,
            modes: &mut self.modes,
            shapes: &mut self.shapes,
            matrix: &mut self.matrix,
        };
        let [a, b, c, etadd] = &mut self.out;
        let result = match algorithm {
            FlexibleAlgorithm::Forward => {
                let out = Forward { qdd: a, thetadd: b, tau_j: c };
                flexible_aba(&self.model, state, tau, External::none(), scratch, out)
            }
            FlexibleAlgorithm::Inverse => {
                let accel = Acceleration { qdd: tau, thetadd: tau };
                let out = Inverse { tau_j: a, tau: b };
                flexible_rnea(&self.model, state, accel, External::none(), scratch, out)
            }
            FlexibleAlgorithm::Hybrid => {
                let accel = Acceleration { qdd: tau, thetadd: tau };
                let etadd = &mut etadd[..self.model.modes()];
                flexible_hybrid(
                    &self.model,
                    state,
                    accel,
                    External::none(),
                    scratch,
                    Inverse { tau_j: a, tau: b },
                    etadd,
                )
            }
        };
        result.unwrap_or_else(|e| panic!("{e}"));
    }
}

/// Numbers that repeat for no two entries; small ones for deflections.
fn vector<T: Scalar>(model: &FlexibleModel<T::Param>, state: usize, kind: usize) -> Vec<T> {
    let joints = model.nv() - model.modes();
    let value = |k: usize| {
        let x = (1.0 + 7.1 * state as f64 + 3.3 * kind as f64 + 1.7 * k as f64).sin();
        T::from_f64(if k < joints { x } else { 0.02 * x })
    };
    (0..model.nv()).map(value).collect()
}

/// `φ_j = 1 − cos((j − ½) π x)` and its slope: clamped at the root, free at the tip.
fn shape(j: usize, x: f64) -> (f64, f64, f64) {
    let k = (j as f64 + 0.5) * PI;
    (1.0 - (k * x).cos(), k * (k * x).sin(), k * k * (k * x).cos())
}

fn arm<P: Scalar>(links: usize, n: usize, elastic: bool) -> FlexibleModel<'static, P> {
    let (ex, ey, ez) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0));
    let at_rest = SpatialInertia {
        mass: 1.0,
        first_moment: ex.scale(0.5),
        rotational: SymMat3::diagonal(0.0, 1.0 / 3.0, 1.0 / 3.0),
    };
    let drive = |parent: Option<usize>, placement| DriveSpec {
        rotor: RotorSpec {
            inertia: 1e-5,
            body: Some(RotorBody { mass: 0.3, transverse_inertia: 1e-5 }),
            mount: MountSpec { body: parent, placement, axis: ez },
        },
        gear_ratio: 100.0,
        transmission: TransmissionSpec::Elastic {
            spring: SpringSpec::Polynomial { stiffness: 1e3, cubic: 0.0 },
            damping: 1.0,
            error: TransmissionError { amplitude: 0.0, cycles_per_rotor_turn: 0.0, phase: 0.0 },
        },
        friction: Friction::<f64>::none(),
    };
    let bodies: Vec<BodySpec> = (0..links)
        .map(|i| {
            let parent = i.checked_sub(1);
            let placement = parent.map_or(Transform::identity(), |_| Transform::from_pose(Mat3::identity(), ex));
            BodySpec {
                parent,
                joint: JointKind::Revolute,
                axis: ez,
                placement,
                inertia: at_rest,
                friction: Friction::<f64>::none(),
                drive: elastic.then(|| drive(parent, placement)),
            }
        })
        .collect();

    let dm = 1.0 / POINTS as f64;
    let sum = |f: &dyn Fn(f64) -> f64| (0..POINTS).map(|p| f((p as f64 + 0.5) * dm) * dm).sum::<f64>();
    let mode = |j: usize| AssumedMode {
        momentum: ey.scale(sum(&|x| shape(j, x).0)),
        moments: Mat3::outer(ex, ey.scale(sum(&|x| x * shape(j, x).0))),
    };
    let pair = |j: usize, k: usize| ModePair {
        moments: Mat3::outer(ey, ey.scale(sum(&|x| shape(j, x).0 * shape(k, x).0))),
        stiffness: 100.0 * sum(&|x| shape(j, x).2 * shape(k, x).2),
        damping: 0.0,
        shortening: Vec3::zero(),
        shortening_moments: Mat3::zero(),
    };
    let tip = |j: usize| StationShape { displacement: ey.scale(shape(j, 1.0).0), rotation: ez.scale(shape(j, 1.0).1) };
    let mut flexible: Vec<_> = (0..links).map(|i| FlexibleLink::new(i as u16, n as u16, 1, false)).collect();
    let mut modes: Vec<_> = (0..links).flat_map(|_| (0..n).map(mode)).collect();
    let mut pairs: Vec<_> = (0..links).flat_map(|_| (0..n * n).map(|p| pair(p / n, p % n))).collect();
    let mut stations = vec![Station::new(ex, SpatialInertia::zero()); links];
    let mut shapes: Vec<_> = (0..links).flat_map(|_| (0..n).map(tip)).collect();
    let on = |i: usize| i.checked_sub(1).map(|station| station as u16);
    let rotor = |i: usize| on(i).filter(|_| elastic);
    let mut seats: Vec<_> = (0..links).map(|i| Seat { parent: on(i), rotor: rotor(i), link: None }).collect();

    let spec = RobotSpec { bodies: &bodies, spring_tables: &[], gravity: ey.scale(-9.81) };
    let mut records = vec![Body::empty(); links];
    let rigid = spec.lower(Fidelity::Complete, &mut records, &mut []).unwrap_or_else(|e| panic!("{e}"));
    let lowered = FlexibleRecords {
        links: &mut flexible,
        modes: &mut modes,
        pairs: &mut pairs,
        stations: &mut stations,
        shapes: &mut shapes,
        shortenings: &mut [],
        seats: &mut seats,
    };
    lowered.lower(&spec, rigid).unwrap_or_else(|e| panic!("{e}"));
    let records: Vec<Body<P>> = records.iter().map(Body::cast).collect();
    FlexibleModel::new(
        gyroflex::model::Model::new(records.leak(), &[], spec.gravity.map(P::from_f64)),
        flexible.iter().map(FlexibleLink::cast).collect::<Vec<_>>().leak(),
        modes.iter().map(AssumedMode::cast).collect::<Vec<_>>().leak(),
        pairs.iter().map(ModePair::cast).collect::<Vec<_>>().leak(),
        stations.iter().map(Station::cast).collect::<Vec<_>>().leak(),
        shapes.iter().map(StationShape::cast).collect::<Vec<_>>().leak(),
        &[],
        seats.leak(),
    )
}
