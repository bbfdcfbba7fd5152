//! The inverse's torque alone, without any feedback, moves the complete robot along the reference.

use gyroflex::dynamics::{External, Forward, State};
use gyroflex::model::Fidelity;
use gyroflex_sim::coordinates::Coordinates;
use gyroflex_sim::inverse::{InverseModel, ReferenceInverse};
use gyroflex_sim::reference::{References, Trajectory};
use gyroflex_sim::scenario::SineTerm;
use gyroflex_sim::{Dynamics, Robot, ScenarioFile};
use std::path::Path;

/// How long the robot is left alone [s].
const TIME: f64 = 2.0;

/// Links, motors, their rates, and the deflections that the inverse keeps, integrated as one system: nothing is held between instants.
struct Both {
    dynamics: Dynamics,
    along: ReferenceInverse,
    references: References,
    n: usize,
}

impl Both {
    fn new(robot: &Robot, references: References) -> Self {
        let file = ScenarioFile::parse("robot: x\nduration: 1", Path::new("x.yaml")).expect("the scenario is valid");
        let joints = Coordinates::of(robot);
        let inverse = InverseModel::new(robot, Fidelity::Complete, 0).expect("the robot can be inverted");
        let along =
            ReferenceInverse::new(inverse, &joints, &references, &file.keys).expect("the references are smooth");
        let dynamics = Dynamics::new(robot.model(Fidelity::Complete).expect("the robot is valid"));
        Self { dynamics, along, references, n: joints.len() }
    }

    fn start(&mut self) -> Vec<f64> {
        self.along.start(&self.references).expect("the start can be inverted");
        let inverse = self.along.inverse();
        [self.along.q(), inverse.theta(0), self.along.derivative(1), inverse.theta(1), inverse.deflection()].concat()
    }

    fn rate(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        let part = |i: usize| &y[i * self.n..(i + 1) * self.n];
        self.along.set_deflection(part(4));
        self.along.at(&self.references, t, 0.0).expect("the motion can be inverted");
        let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; self.n]);
        let state = State { q: part(0), qd: part(2), theta: part(1), thetad: part(3) };
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        let inverse = self.along.inverse();
        self.dynamics.forward(state, inverse.tau(0), External::none(), out).expect("it fits");
        [part(2), part(3), &qdd, &thetadd, inverse.deflection_rate()].concat()
    }

    /// The largest tracking error of any joint under the classical Runge-Kutta scheme [rad].
    fn error(&mut self, step: f64) -> f64 {
        let steps = (TIME / step).round() as usize;
        let (mut y, mut worst) = (self.start(), 0.0_f64);
        for i in 0..steps {
            let t = i as f64 * step;
            let along = |y: &[f64], k: &[f64], h: f64| y.iter().zip(k).map(|(y, k)| y + h * k).collect::<Vec<_>>();
            let k1 = self.rate(t, &y);
            let k2 = self.rate(t + 0.5 * step, &along(&y, &k1, 0.5 * step));
            let k3 = self.rate(t + 0.5 * step, &along(&y, &k2, 0.5 * step));
            let k4 = self.rate(t + step, &along(&y, &k3, step));
            for (j, y) in y.iter_mut().enumerate() {
                *y += step / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]);
            }
            for (j, q) in y.iter().take(self.n).enumerate() {
                worst = worst.max((q - self.references.point(j, t + step).q).abs());
            }
        }
        worst
    }
}

/// Each joint on sines of its own.
fn references(n: usize) -> References {
    let trajectory = |i: usize| Trajectory::Sines {
        offset: 0.3 - 0.2 * i as f64,
        terms: vec![SineTerm { amplitude: 0.3, frequency: 0.4 + 0.13 * i as f64, phase: i as f64 }],
    };
    References::new((0..n).map(trajectory).collect())
}

/// What is left is the integrator's: sixteen times less with half the step.
#[test]
fn open_loop_torque_of_the_inverse_tracks_to_the_accuracy_of_the_integrator() {
    for (name, steps, bound) in
        [("lwr", [1e-4, 5e-5], 1e-9), ("manutec_r3", [2e-4, 1e-4], 1e-9), ("puma560", [5e-5, 2.5e-5], 1e-7)]
    {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../robots/{name}/robot.yaml"));
        let robot = gyroflex_sim::load::load(&path, &Default::default()).expect("the robot loads");
        let mut both = Both::new(&robot, references(robot.bodies.len()));
        let errors = steps.map(|step| both.error(step));
        println!("{name}: steps {steps:?} s, largest errors {errors:?} rad over {TIME} s");
        assert!(errors[1] < bound, "{name}: errors {errors:?}");
        assert!(errors[0] > 8.0 * errors[1] || errors[1] < 1e-9, "{name}: errors {errors:?}");
    }
}
