//! The core against reference cases from outside; `crates/testkit/tests/reference/README.md` tells whence.

use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::reference::{Case, number, numbers, rows};
use gyroflex_testkit::tolerance::{assert_close, assert_close_above, norm};
use gyroflex_tests::Core;
use serde_json::Value;

const TOLERANCE: f64 = 1e-10;
/// The four models and their labels in the files.
const MODELS: [(Fidelity, &str); 4] = [
    (Fidelity::Complete, "complete_consistent"),
    (Fidelity::Reduced, "reduced_consistent"),
    (Fidelity::Rigid, "rigid_full"),
    (Fidelity::RigidReflected, "rigid_diag"),
];

#[test]
fn forward_dynamics() {
    for case in Case::of_kind("forward") {
        for (fidelity, label) in MODELS {
            let core = Core::<f64>::new(&case.spec(), fidelity);
            for sample in case.samples() {
                let (got, want) = (core.forward(&case.state(sample)), &sample["expected"][label]);
                let context = format!("{} {label}", case.name);
                assert_close("qdd", &context, &got.qdd, &numbers(&want["qdd"]), TOLERANCE);
                if fidelity.is_elastic() {
                    let thetadd = case.reflect(&numbers(&want["thetadd_m"]));
                    assert_close("thetadd", &context, &got.thetadd, &thetadd, TOLERANCE);
                    assert_close("tau_j", &context, &got.tau_j, &numbers(&want["tau_J"]), TOLERANCE);
                } else {
                    let m = core.mass_matrix(&case.state(sample));
                    assert_close("M", &context, &m, &rows(&want["M"]), TOLERANCE);
                }
            }
        }
    }
}

#[test]
fn inverse_dynamics_at_a_point() {
    for case in Case::of_kind("inverse_point") {
        let core = Core::<f64>::new(&case.spec(), Fidelity::Complete);
        for sample in case.samples() {
            let want = &sample["expected"]["consistent"];
            let s = State { tau_ext: numbers(&want["d_l"]), ..case.state(sample) };
            let (got, transmitted) = (core.inverse(&s), core.forward(&s).tau_j);
            assert_close_above("tau_j", &case.name, &got.tau_j, &transmitted, TOLERANCE, norm(&s.tau_ext));
            assert_close("tau", &case.name, &got.tau, &case.reflect_torque(&numbers(&want["u"])), TOLERANCE);
        }
    }
}

#[test]
fn inverse_dynamics_along_a_trajectory() {
    for case in Case::of_kind("inverse_trajectory") {
        for (fidelity, label) in MODELS.into_iter().filter(|(f, _)| f.is_elastic()) {
            let core = Core::<f64>::new(&case.spec(), fidelity);
            for sample in case.samples() {
                let want = case.expected(sample, label);
                let motor = |key: &str| case.reflect(&numbers(&want[key]));
                let s = State {
                    theta: motor("theta_m"),
                    thetad: motor("thetad_m"),
                    thetadd: motor("thetadd_m"),
                    ..case.state(sample)
                };
                let (got, context) = (core.inverse(&s), format!("{} {label} at {}", case.name, sample["t"]));
                assert_close("tau_j", &context, &got.tau_j, &numbers(&want["tau_J"]), TOLERANCE);
                assert_close("tau", &context, &got.tau, &case.reflect_torque(&numbers(&want["u"])), TOLERANCE);
            }
        }
    }
}

#[test]
fn matrices_gravity_velocity_terms_and_energies() {
    for case in Case::of_kind("matrices") {
        let core = Core::<f64>::new(&case.spec(), Fidelity::Complete);
        let mut level = None;
        for sample in case.samples() {
            let (s, want) = (case.state(sample), &sample["expected"]);
            let n = s.qd.len();
            assert_close("M_l", &case.name, &core.mass_matrix(&s), &rows(&want["M_l"]), TOLERANCE);
            let coupling: Vec<f64> = rows(&want["M_ml"]).chunks(n).flat_map(|r| case.reflect_torque(r)).collect();
            assert_close("S", &case.name, &core.coupling(&s), &coupling, TOLERANCE);
            let motor = rows(&want["M_m"]).into_iter().step_by(n + 1).collect::<Vec<_>>();
            let motor = case.reflect_torque(&case.reflect_torque(&motor));
            assert_close("B", &case.name, &core.reflected_inertia(), &motor, TOLERANCE);

            // Inverse dynamics without acceleration: gravity at rest, velocity terms and link friction in motion.
            let still = core.inverse(&State { qd: vec![0.0; n], thetad: vec![0.0; n], ..s.clone() }).tau_j;
            assert_close("g", &case.name, &still, &numbers(&want["g"]), TOLERANCE);
            let moving = core.inverse(&s).tau_j;
            let friction = friction_of_links(&case, &s);
            let coriolis: Vec<f64> = (0..n).map(|i| moving[i] - still[i] - friction[i]).collect();
            let size = norm(&moving);
            assert_close_above("C qd", &case.name, &coriolis, &numbers(&want["coriolis_link"]), TOLERANCE, size);

            let (energy, want) = (core.energy(&s), &want["energy"]);
            assert_close("T", &case.name, &[energy.kinetic], &[number(&want["kinetic"])], TOLERANCE);
            assert_close_above("U", &case.name, &[energy.elastic], &[number(&want["spring"])], TOLERANCE, 1e-3);
            let offset = energy.gravity - number(&want["gravity"]);
            let first = *level.get_or_insert(offset);
            assert_close_above("V", &case.name, &[offset], &[first], TOLERANCE, energy.gravity.abs());
        }
    }
}

/// Unforced motion; springs ask for a small step, rigid gears do not.
#[test]
fn simulation() {
    for case in Case::of_kind("simulation") {
        let times = numbers(&case.json["times"]);
        for (fidelity, label) in MODELS {
            let core = Core::<f64>::new(&case.spec(), fidelity);
            let want = &case.json["expected"][label.replace("_consistent", "")];
            let mut s = case.state(&case.json);
            for (k, window) in times.windows(2).enumerate() {
                let steps = if fidelity.is_elastic() { 5000 } else { 100 };
                s = core.integrate(&s, (window[1] - window[0]) / steps as f64, steps);
                let context = format!("{} {label} at {}", case.name, window[1]);
                assert_close("q", &context, &s.q, &numbers(&want["q"][k + 1]), 1e-9);
                assert_close("qd", &context, &s.qd, &numbers(&want["qd"][k + 1]), 1e-8);
                if fidelity.is_elastic() {
                    let theta = case.reflect(&numbers(&want["theta_m"][k + 1]));
                    assert_close("theta", &context, &s.theta, &theta, 1e-9);
                }
            }
        }
    }
}

fn friction_of_links(case: &Case, s: &State) -> Vec<f64> {
    let read = |(a, v): (&Value, &f64)| {
        let f = &a["link_friction"];
        if f.is_null() {
            return 0.0;
        }
        number(&f["viscous"]) * v + number(&f["coulomb"]) * (v / number(&f["tanh_velocity"])).tanh()
    };
    case.json["robot"]["actuators"].as_array().into_iter().flatten().zip(&s.qd).map(read).collect()
}
