//! Robots some of whose links bend.

use super::library::{inertia, of_energy, of_poses, reflected};
use super::scratch::Scratch;
use super::subject::{DOUBLE, Known, SINGLE, Subject, bending_equals_library, grown_bending};
use gyroflex::dynamics::*;
use gyroflex::model::{Drive, Fidelity};
use gyroflex::spatial::Transform;
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::Quantity;
use gyroflex_testkit::random::RandomFlexible;
use gyroflex_testkit::tolerance::{Real, assert_close_above, norm};

/// Inverse dynamics.
pub fn inverse(s: &Subject) -> Vec<Known> {
    let [tau_j, tau] = torques(s, s.at(), &s.state.qdd, &s.state.thetadd);
    vec![Known::new("tau_j", tau_j), Known::new("tau", tau)]
}

pub fn energies(s: &Subject) -> Vec<Known> {
    let model = s.robot().flexible.expect("a link bends");
    let Energy { kinetic, gravity, elastic } =
        flexible_energy(&model, s.at(), Scratch::of(&model).lend()).expect("it fits");
    of_energy(s, kinetic, gravity, elastic)
}

pub fn poses(s: &Subject) -> Vec<Known> {
    let model = s.robot().flexible.expect("a link bends");
    let mut links = vec![Transform::identity(); s.bodies.len()];
    let mut stations = vec![Transform::identity(); model.stations().len()];
    let out = FlexiblePlacements { links: &mut links, stations: &mut stations };
    flexible_placements(&model, &s.state.q, Scratch::of(&model).lend(), out).expect("it fits");
    let links = of_poses(&links, ["positions", "rotations"]);
    let stations = of_poses(&stations, ["station_positions", "station_rotations"]);
    links.into_iter().chain(stations).collect()
}

fn torques(s: &Subject, state: State<f64>, qdd: &[f64], thetadd: &[f64]) -> [Vec<f64>; 2] {
    let model = s.robot().flexible.expect("a link bends");
    let [mut tau_j, mut tau] = [(); 2].map(|()| vec![0.0; model.nv()]);
    let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
    let accel = Acceleration { qdd, thetadd };
    flexible_rnea(&model, state, accel, External::none(), Scratch::of(&model).lend(), out).expect("it fits");
    [tau_j, tau]
}

#[test]
fn generated_inverse_dynamics_of_bending_links_equals_library() {
    bending_equals_library(40, Quantity::Inverse, inverse);
}

#[test]
fn generated_mass_matrix_of_bending_links_equals_library() {
    bending_equals_library(40, Quantity::MassMatrix, |s| vec![Known::new("m", inertia(s)[0].clone())]);
}

#[test]
fn generated_coupling_of_bending_links_equals_library() {
    bending_equals_library(40, Quantity::Coupling, |s| vec![Known::new("s", inertia(s)[1].clone())]);
}

#[test]
fn generated_reflected_inertia_of_bending_links_equals_library() {
    bending_equals_library(20, Quantity::ReflectedInertia, reflected);
}

#[test]
fn generated_energies_of_bending_links_equal_library() {
    bending_equals_library(40, Quantity::Energy, energies);
}

#[test]
fn generated_placements_of_bending_links_equal_library() {
    bending_equals_library(40, Quantity::Placements, poses);
}

/// By the torques that accelerations ask for, as of links that do not bend.
#[test]
fn generated_forward_dynamics_of_bending_links_equals_library() {
    for seed in 0..40 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &grown_bending().in_model(fidelity));
            let mut s = Subject::bending(&robot, fidelity);
            let function = s.function(Quantity::Forward).expect("every robot has it");
            accelerates_as_the_library::<f64>(&s, &function, DOUBLE);
            if s.round() {
                accelerates_as_the_library::<f32>(&s, &function, SINGLE);
            }
        }
    }
}

pub fn accelerates_as_the_library<T: Real>(s: &Subject, function: &Function, tolerance: f64) {
    let model = s.robot().flexible.expect("a link bends");
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; model.nv()]);
    let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    flexible_aba(&model, s.at(), &s.state.tau, External::none(), Scratch::of(&model).lend(), out).expect("it fits");
    let got = s.evaluate::<T>(function, &[]);
    let got = |name: &str| got.iter().find(|(of, _)| of == name).map(|(_, x)| x.clone());
    let got_qdd = got("qdd").expect("it is there");
    let got_thetadd = got("thetadd").unwrap_or(got_qdd.clone());
    let (asks, asked) = (torques(s, s.at(), &got_qdd, &got_thetadd), torques(s, s.at(), &qdd, &thetadd));
    let sum = norm(&inertia(s)[0]) * norm(&qdd);
    let what = |of: &str| format!("forward dynamics, {of} in {}", T::NAME);
    assert_close_above(&what("torques on joints"), s, &asks[0], &asked[0], tolerance, sum);
    assert_close_above(&what("torques of motors"), s, &asks[1], &asked[1], tolerance, sum);
    assert_close_above(&what("tau_j"), s, &got("tau_j").expect("it is there"), &tau_j, tolerance, sum);
}

#[test]
fn generated_bias_forces_of_bending_links_are_what_is_left_of_inverse_dynamics() {
    bending_equals_library(40, Quantity::Bias, bias_forces);
}

/// Inverse dynamics is `M q̈ + S θ̈` and the bias; friction on both sides; and what bent links ask for, `K η + D η̇`.
pub fn bias_forces(s: &Subject) -> Vec<Known> {
    let rest = vec![0.0; s.state.qd.len()];
    let [mut link, tau] = torques(s, s.at(), &rest, &rest);
    let size = norm(&link).max(norm(&tau));
    let model = s.robot().flexible.expect("a link bends");
    let (mut motor, x) = (rest, &s.state);
    for body in model.rigid().bodies().iter().filter(|body| body.joint.nv() == 1) {
        let k = body.v_index();
        let friction = body.friction.torque(x.qd[k]);
        match &body.drive {
            Some(Drive { rotor, elastic: Some(elastic) }) => {
                let slope = elastic.error.map_or(0.0, |e| e.value_and_slope(x.theta[k], rotor.gear_ratio).1);
                motor[k] = tau[k] - (1.0 - slope) * link[k] - rotor.reflected_friction(x.thetad[k]);
                link[k] -= friction;
            }
            Some(Drive { rotor, elastic: None }) => {
                link[k] = tau[k] - friction - rotor.reflected_friction(x.qd[k]);
            }
            None => link[k] -= friction,
        }
    }
    let (nq, nv) = (model.rigid().nq(), model.rigid().nv());
    for of in model.links() {
        let modes = of.mode_range();
        for (p, pair) in model.pairs()[of.pair_range()].iter().enumerate() {
            let (j, k) = (modes.start + p / modes.len(), modes.start + p % modes.len());
            link[nv + j] -= pair.stiffness * x.q[nq + k] + pair.damping * x.qd[nv + k];
        }
    }
    vec![Known::new("link", link).above(size), Known::new("motor", motor).above(size)]
}

#[test]
fn generated_gravity_torques_of_bending_links_equal_library() {
    bending_equals_library(40, Quantity::Gravity, gravity);
}

/// The force that holds the robot is the slope of its potential, which the library knows by another route.
pub fn gravity(s: &Subject) -> Vec<Known> {
    let model = s.robot().flexible.expect("a link bends");
    let rest = vec![0.0; s.state.qd.len()];
    let straight = State { q: &s.state.q, qd: &rest, theta: &rest, thetad: &rest };
    let mut g = torques(s, straight, &rest, &rest)[0].clone();
    let size = norm(&g);
    let (nq, nv) = (model.rigid().nq(), model.rigid().nv());
    for of in model.links() {
        let modes = of.mode_range();
        for (p, pair) in model.pairs()[of.pair_range()].iter().enumerate() {
            let (j, k) = (modes.start + p / modes.len(), modes.start + p % modes.len());
            g[nv + j] -= pair.stiffness * s.state.q[nq + k];
        }
    }
    vec![Known::new("g", g).above(size)]
}

/// One block a link, as its records have it.
pub fn stiffness(s: &Subject) -> Vec<Known> {
    let model = s.robot().flexible.expect("a link bends");
    let modes = model.modes();
    let mut modal = vec![0.0; modes * modes];
    for of in model.links() {
        let own = of.mode_range();
        for (p, pair) in model.pairs()[of.pair_range()].iter().enumerate() {
            modal[(own.start + p / own.len()) * modes + own.start + p % own.len()] = pair.stiffness;
        }
    }
    vec![Known::new("modal", modal)]
}

/// Modes have the stiffness that the description gives their links, one block a link; transmissions have what they have on a robot
/// whose links do not bend.
#[test]
fn generated_stiffness_of_bending_links_is_that_of_the_description() {
    for seed in 0..20 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &grown_bending().in_model(fidelity));
            let s = Subject::bending(&robot, fidelity);
            let got = s.evaluate::<f64>(&s.function(Quantity::Stiffness).expect("a link bends"), &[]);
            let of = |name: &str| got.iter().find(|(of, _)| of == name).map(|(_, x)| x.as_slice());
            let modes = robot.modes();
            let (mut want, mut first) = (vec![0.0; modes * modes], 0);
            for link in &robot.links {
                let n = link.modes();
                for (j, k) in (0..n * n).map(|p| (p / n, p % n)) {
                    want[(first + j) * modes + first + k] = link.stiffness[(j, k)];
                }
                first += n;
            }
            assert_eq!(of("modal"), Some(want.as_slice()), "{s}");
            let stiff = Subject::of(&robot.robot, fidelity);
            let Some(function) = stiff.function(Quantity::Stiffness) else { continue };
            let k = &stiff.evaluate::<f64>(&function, &[])[0].1;
            assert_close_above("k", &s, &of("k").expect("it is elastic")[..k.len()], k, DOUBLE, 0.0);
        }
    }
}
