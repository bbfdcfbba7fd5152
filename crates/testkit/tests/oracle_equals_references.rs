//! The dense oracle against the reference cases: what makes it an oracle.

use gyroflex::model::{Fidelity, RobotSpec};
use gyroflex_testkit::State;
use gyroflex_testkit::dense::Oracle;
use gyroflex_testkit::reference::{Case, number, numbers, rows};
use gyroflex_testkit::tolerance::{assert_close, assert_close_above, norm};

const TOLERANCE: f64 = 1e-10;

fn without_gravity<'a>(spec: RobotSpec<'a>, fidelity: Fidelity) -> Oracle<'a> {
    Oracle::new(spec, fidelity).with_gravity([0.0; 3])
}

#[test]
fn elastic_forward_dynamics() {
    for case in Case::of_kind("forward") {
        for (fidelity, label) in
            [(Fidelity::Complete, "complete_consistent"), (Fidelity::Reduced, "reduced_consistent")]
        {
            for sample in case.samples() {
                let want = &sample["expected"][label];
                let got = Oracle::new(case.spec(), fidelity).forward(&case.state(sample));
                let context = format!("{} {label}", case.name);
                assert_close("qdd", &context, &got.qdd, &numbers(&want["qdd"]), TOLERANCE);
                assert_close("tau_j", &context, &got.tau_j, &numbers(&want["tau_J"]), TOLERANCE);
                let thetadd = case.reflect(&numbers(&want["thetadd_m"]));
                assert_close("thetadd", &context, &got.thetadd, &thetadd, TOLERANCE);
            }
        }
    }
}

#[test]
fn rigid_forward_dynamics_mass_matrix_and_bias() {
    for case in Case::of_kind("forward") {
        for (fidelity, label) in [(Fidelity::Rigid, "rigid_full"), (Fidelity::RigidReflected, "rigid_diag")] {
            for sample in case.samples() {
                let want = &sample["expected"][label];
                let (s, oracle) = (case.state(sample), Oracle::new(case.spec(), fidelity));
                let context = format!("{} {label}", case.name);
                assert_close("qdd", &context, &oracle.forward(&s).qdd, &numbers(&want["qdd"]), TOLERANCE);
                let m = oracle.matrices(&s).m;
                assert_close("M", &context, m.as_slice(), &rows(&want["M"]), TOLERANCE);
                // The bias is the torque at rest of the same motion: link rows plus rotor rows behind the gear.
                let at_rest = State { qdd: vec![0.0; s.qd.len()], ..s };
                let forces = oracle.tree_forces(&at_rest);
                let n = at_rest.qd.len();
                let bias: Vec<f64> = (0..n).map(|i| forces[i] + forces[n + i]).collect();
                assert_close("h", &context, &bias, &numbers(&want["h"]), TOLERANCE);
            }
        }
    }
}

#[test]
fn inverse_dynamics_at_a_point() {
    for case in Case::of_kind("inverse_point") {
        for sample in case.samples() {
            let (s, want) = (case.state(sample), &sample["expected"]);
            let n = s.qd.len();
            let oracle = Oracle::new(case.spec(), Fidelity::Complete);
            let forces = oracle.tree_forces(&s);
            assert_close("link rows", &case.name, &forces[..n], &numbers(&want["tree_link"]), TOLERANCE);
            let motor = case.reflect_torque(&numbers(&want["tree_motor"]));
            assert_close("motor rows", &case.name, &forces[n..], &motor, TOLERANCE);

            // With the link residual as external force, the transmission delivers what its deflection says.
            let tau_ext = numbers(&want["consistent"]["d_l"]);
            let s = State { tau_ext, tau: vec![0.0; n], ..s };
            let got = oracle.inverse(&s);
            let transmitted = oracle.forward(&s).tau_j;
            assert_close_above("tau_j", &case.name, &got.tau_j, &transmitted, TOLERANCE, norm(&s.tau_ext));
            let tau = case.reflect_torque(&numbers(&want["consistent"]["u"]));
            assert_close("tau", &case.name, &got.tau, &tau, TOLERANCE);
        }
    }
}

#[test]
fn inverse_dynamics_along_a_trajectory() {
    for case in Case::of_kind("inverse_trajectory") {
        for (fidelity, label) in
            [(Fidelity::Complete, "complete_consistent"), (Fidelity::Reduced, "reduced_consistent")]
        {
            for sample in case.samples() {
                let want = case.expected(sample, label);
                let motor = |key: &str| case.reflect(&numbers(&want[key]));
                let s = State {
                    theta: motor("theta_m"),
                    thetad: motor("thetad_m"),
                    thetadd: motor("thetadd_m"),
                    tau: case.reflect_torque(&numbers(&want["u"])),
                    ..case.state(sample)
                };
                let context = format!("{} {label} at {}", case.name, sample["t"]);
                let oracle = Oracle::new(case.spec(), fidelity);
                let torques = oracle.inverse(&s);
                assert_close("tau_j", &context, &torques.tau_j, &numbers(&want["tau_J"]), TOLERANCE);
                assert_close("tau", &context, &torques.tau, &s.tau, TOLERANCE);
                let accelerations = oracle.forward(&s);
                // The deflections, small differences, carry the rounding of the angles: measured in forces.
                let floor = norm(&s.tau) / 1e-3;
                assert_close_above("qdd", &context, &accelerations.qdd, &s.qdd, TOLERANCE, floor);
                assert_close_above("thetadd", &context, &accelerations.thetadd, &s.thetadd, TOLERANCE, floor);
            }
        }
    }
}

/// Unforced and undamped: the oracle integrated by the classical Runge-Kutta method.
#[test]
fn simulation() {
    for case in Case::of_kind("simulation") {
        let times = numbers(&case.json["times"]);
        let labels = ["complete", "reduced", "rigid_full", "rigid_diag"];
        for (fidelity, label) in Fidelity::ALL.into_iter().zip(labels) {
            let oracle = Oracle::new(case.spec(), fidelity);
            let mut s = case.state(&case.json);
            let want = &case.json["expected"][label];
            for (k, window) in times.windows(2).enumerate() {
                // Springs are the fast part; a rigid gear has none.
                let steps = if fidelity.is_elastic() { 3000 } else { 100 };
                for _ in 0..steps {
                    runge_kutta(&oracle, &mut s, (window[1] - window[0]) / f64::from(steps));
                }
                let context = format!("{} {label} at {}", case.name, window[1]);
                assert_close("q", &context, &s.q, &numbers(&want["q"][k + 1]), 1e-8);
                assert_close("qd", &context, &s.qd, &numbers(&want["qd"][k + 1]), 1e-7);
                if want.get("theta_m").is_some() {
                    let theta = case.reflect(&numbers(&want["theta_m"][k + 1]));
                    assert_close("theta", &context, &s.theta, &theta, 1e-8);
                }
                if want.get("energy_kinetic").is_some() {
                    let energy = [number(&want["energy_kinetic"][k + 1])];
                    assert_close("T", &context, &[oracle.energy(&s).kinetic], &energy, 1e-7);
                }
            }
        }
    }
}

fn runge_kutta(oracle: &Oracle<'_>, s: &mut State, h: f64) {
    let add = |x: &[f64], k: f64, v: &[f64]| -> Vec<f64> { x.iter().zip(v).map(|(x, v)| x + k * v).collect() };
    let start = s.clone();
    let (mut slope, mut end) = (start.clone(), start.clone());
    for (weight, next) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
        let a = oracle.forward(&slope);
        end.q = add(&end.q, weight * h / 6.0, &slope.qd);
        end.theta = add(&end.theta, weight * h / 6.0, &slope.thetad);
        end.qd = add(&end.qd, weight * h / 6.0, &a.qdd);
        end.thetad = add(&end.thetad, weight * h / 6.0, &a.thetadd);
        slope = State {
            q: add(&start.q, next * h, &slope.qd),
            theta: add(&start.theta, next * h, &slope.thetad),
            qd: add(&start.qd, next * h, &a.qdd),
            thetad: add(&start.thetad, next * h, &a.thetadd),
            ..slope
        };
    }
    *s = end;
}

#[test]
fn matrices_and_energies() {
    for case in Case::of_kind("matrices") {
        let mut offset = None;
        for sample in case.samples() {
            let (s, want) = (case.state(sample), &sample["expected"]);
            let (n, gears) = (s.qd.len(), &case.gear_ratios);
            let oracle = Oracle::new(case.spec(), Fidelity::Complete);
            let got = oracle.matrices(&s);
            assert_close("M_l", &case.name, got.m.as_slice(), &rows(&want["M_l"]), TOLERANCE);
            let coupling: Vec<f64> = rows(&want["M_ml"]).iter().enumerate().map(|(i, x)| x * gears[i % n]).collect();
            assert_close("S", &case.name, got.coupling.transpose().as_slice(), &coupling, TOLERANCE);
            let motor: Vec<f64> =
                rows(&want["M_m"]).iter().enumerate().map(|(i, x)| x * gears[i % n] * gears[i / n]).collect();
            assert_close("B", &case.name, got.motor.as_slice(), &motor, TOLERANCE);

            let still = State { qd: vec![0.0; n], thetad: vec![0.0; n], ..s.clone() };
            assert_close("g", &case.name, &oracle.tree_forces(&still)[..n], &numbers(&want["g"]), TOLERANCE);
            let coriolis = without_gravity(case.spec(), Fidelity::Complete).tree_forces(&s);
            assert_close("C qd", &case.name, &coriolis[..n], &numbers(&want["coriolis_link"]), TOLERANCE);
            let motor = case.reflect_torque(&numbers(&want["coriolis_motor"]));
            assert_close_above("C2 qd", &case.name, &coriolis[n..], &motor, TOLERANCE, norm(&coriolis));

            let (energy, want) = (oracle.energy(&s), &want["energy"]);
            assert_close("T", &case.name, &[energy.kinetic], &[number(&want["kinetic"])], TOLERANCE);
            let elastic = [number(&want["spring"])];
            assert_close_above("U", &case.name, &[energy.elastic], &elastic, TOLERANCE, 1e-3);
            let level = energy.gravity - number(&want["gravity"]);
            let free = *offset.get_or_insert(level);
            assert_close_above("V", &case.name, &[level], &[free], TOLERANCE, energy.gravity.abs());
        }
    }
}

/// `C`, `C1`, `C2` of the files are linear in the velocities with symmetric coefficients, so that polarisation of the
/// velocity terms gives them column by column.
#[test]
fn christoffel_matrices_are_polarisations_of_the_velocity_terms() {
    for case in Case::of_kind("matrices") {
        for sample in case.samples() {
            let (s, want) = (case.state(sample), &sample["expected"]);
            let (n, gears) = (s.qd.len(), &case.gear_ratios);
            let oracle = without_gravity(case.spec(), Fidelity::Complete);
            let terms = |qd: &[f64], thetad: &[f64]| {
                oracle.tree_forces(&State { qd: qd.to_vec(), thetad: thetad.to_vec(), ..s.clone() })
            };
            let zero = vec![0.0; n];
            let column = |key: &str, j: usize| -> Vec<f64> {
                want[key].as_array().into_iter().flatten().map(|row| number(&row[j])).collect()
            };
            let floor = norm(&rows(&want["C"])).max(1.0);
            for j in 0..n {
                let mut unit = zero.clone();
                unit[j] = 1.0;
                let sum: Vec<f64> = s.qd.iter().zip(&unit).map(|(a, b)| a + b).collect();
                let (both, own, other) = (terms(&sum, &zero), terms(&s.qd, &zero), terms(&unit, &zero));
                let polar: Vec<f64> = (0..2 * n).map(|i| 0.5 * (both[i] - own[i] - other[i])).collect();
                assert_close_above("C", &case.name, &polar[..n], &column("C", j), TOLERANCE, floor);
                let c2 = case.reflect_torque(&column("C2", j));
                assert_close_above("C2", &case.name, &polar[n..], &c2, TOLERANCE, floor);

                // One motor turning: linear in its velocity.
                let spinning = terms(&s.qd, &unit);
                let c1: Vec<f64> = (0..n).map(|i| spinning[i] - own[i]).collect();
                let want: Vec<f64> = column("C1", j).iter().map(|x| x * gears[j]).collect();
                assert_close_above("C1", &case.name, &c1, &want, TOLERANCE, floor);
            }
        }
    }
}
