//! Laws of loads: a payload is the same mass written into the URDF.

use gyroflex::dynamics::{External, Forward, State};
use gyroflex_sim::load::{LoadOptions, load_urdf_text};
use gyroflex_sim::{Dynamics, Error, Fidelity, Robot};

/// An arm of two elastic joints with a flange turned and shifted on the second link, and what else is written at its end.
fn urdf(more: &str) -> String {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0.02 0.1 0.2'/><mass value='2'/>\
             <inertia ixx='0.05' iyy='0.04' izz='0.03' ixy='0.001' ixz='0' iyz='-0.002'/></inertial></link>"
        )
    };
    format!(
        "<robot name='r'>{}{}{}<link name='flange'/>\
         <joint name='a' type='revolute'><parent link='base'/><child link='upper'/><origin xyz='0 0 0.3'/><axis xyz='0 0.6 0.8'/></joint>\
         <joint name='b' type='revolute'><parent link='upper'/><child link='lower'/><origin xyz='0.1 0 0.4' rpy='0.2 0 0'/><axis xyz='1 0 0'/></joint>\
         <joint name='f' type='fixed'><parent link='lower'/><child link='flange'/><origin xyz='0 0.2 0.3' rpy='0.4 -0.5 0.6'/></joint>\
         {more}</robot>",
        link("base"),
        link("upper"),
        link("lower")
    )
}

const DRIVES: &str = "urdf: r.urdf\ndrives:
  a: {rotor: {inertia: 1.0e-4}, gear_ratio: 100, transmission: {stiffness: 900, damping: 2}}
  b: {rotor: {inertia: 2.0e-4}, gear_ratio: -80, transmission: {stiffness: 700, damping: 1}}\n";

fn load(urdf: &str, payload: &str, floating: bool) -> Result<Robot, Error> {
    let options = LoadOptions { floating, ..LoadOptions::default() };
    load_urdf_text(urdf, "r.urdf", Some(&format!("{DRIVES}{payload}")), &options)
}

/// Everything that moves: accelerations, torques of the transmissions and energies at a state, inertia matrix and coupling.
fn dynamics(robot: &Robot, model: Fidelity) -> Vec<f64> {
    let mut dynamics = Dynamics::new(robot.model(model).expect("it is physical"));
    let (nq, nv) = (dynamics.nq(), dynamics.nv());
    let wave = |n: usize, phase: f64| (0..n).map(|i| (1.7 * i as f64 + phase).sin()).collect::<Vec<_>>();
    let mut q = wave(nq, 0.3);
    if robot.is_floating() {
        q[3..7].copy_from_slice(&[0.5, -0.5, 0.5, 0.5]);
    }
    let (qd, thetad, tau) = (wave(nv, 1.0), wave(nv, 2.0), wave(nv, 3.0));
    let mut theta = q[nq - nv..].to_vec();
    theta.iter_mut().for_each(|x| *x += 0.01);
    let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
    let mut all = vec![0.0; 3 * nv + 2 * nv * nv];
    let (qdd, rest) = all.split_at_mut(nv);
    let (thetadd, rest) = rest.split_at_mut(nv);
    let (tau_j, rest) = rest.split_at_mut(nv);
    let (m, s) = rest.split_at_mut(nv * nv);
    dynamics.forward(state, &tau, External::none(), Forward { qdd, thetadd, tau_j }).expect("slices fit");
    dynamics.mass_matrix(&q, m).expect("slices fit");
    dynamics.coupling(&q, s).expect("slices fit");
    let energy = dynamics.energy(state).expect("slices fit");
    all.extend([energy.kinetic, energy.gravity]);
    all
}

#[test]
fn a_payload_moves_as_the_same_mass_on_a_fixed_link_of_the_urdf() {
    let written = "<link name='load'><inertial><origin xyz='0.01 -0.02 0.03'/><mass value='3.5'/>\
                   <inertia ixx='0.02' iyy='0.03' izz='0.04' ixy='0.002' ixz='-0.003' iyz='0.004'/></inertial></link>\
                   <joint name='l' type='fixed'><parent link='LINK'/><child link='load'/><origin xyz='0.1 0.2 0.3'/></joint>";
    for link in ["flange", "lower", "upper"] {
        let payload = format!(
            "payload: {{link: {link}, mass: 3.5, xyz: [0.11, 0.18, 0.33], inertia: [0.02, 0.03, 0.04, 0.002, -0.003, 0.004]}}"
        );
        for floating in [false, true] {
            let given = load(&urdf(""), &payload, floating).expect("it is physical");
            let want = load(&urdf(&written.replace("LINK", link)), "", floating).expect("it is physical");
            let empty = load(&urdf(""), "", floating).expect("it is physical");
            for model in Fidelity::ALL {
                let [given, want, empty] = [&given, &want, &empty].map(|robot| dynamics(robot, model));
                let size = want.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                let apart = |a: &[f64]| a.iter().zip(&want).fold(0.0, |most: f64, (x, y)| most.max((x - y).abs()));
                assert!(apart(&given) < 1e-12 * size, "{link}, {}: {}", model.name(), apart(&given));
                assert!(apart(&empty) > 1e-3 * size, "{link}: the load does nothing");
            }
        }
    }
}

/// A point at the origin of a link that the joint `a` moves adds `m r²` about that joint.
#[test]
fn a_point_load_has_the_inertia_of_a_point() {
    let at = |payload: &str| {
        let robot = load(&urdf(""), payload, false).expect("it is physical");
        let mut dynamics = Dynamics::new(robot.model(Fidelity::Reduced).expect("it is physical"));
        let mut m = [0.0; 4];
        dynamics.mass_matrix(&[0.2, -0.3], &mut m).expect("slices fit");
        m
    };
    // The origin of `lower` stands at (0.1, 0, 0.4) from joint `a`, whose axis is (0, 0.6, 0.8).
    let [x, y, z] = [0.1, 0.0, 0.4_f64];
    let along = 0.6 * y + 0.8 * z;
    let square = x * x + y * y + z * z - along * along;
    let (empty, loaded) = (at(""), at("payload: {link: lower, mass: 5}"));
    assert!((loaded[0] - empty[0] - 5.0 * square).abs() < 1e-13);
    assert!((loaded[3] - empty[3]).abs() < 1e-13, "it lies on joint `b`");
}

#[test]
fn the_table_says_where_the_load_comes_from() {
    let robot =
        load(&urdf(""), "payload: {link: flange, mass: 3.5, xyz: [0, 0, 0.1]}\n", false).expect("it is physical");
    let row = |key: &str| robot.table.iter().find(|r| r.key == key).unwrap_or_else(|| panic!("no row {key}"));
    let mass = row("payload.mass");
    assert_eq!((mass.joint.as_str(), mass.value.as_str(), mass.unit), ("b", "3.5", "kg"));
    assert_eq!(mass.source, "robot.yaml:5");
    assert_eq!(row("payload.inertia").source, "default");
    assert_eq!(row("payload.link").value, "`flange`");
}

#[test]
fn a_load_on_the_world_is_reported() {
    let robot = load(&urdf(""), "payload: {link: base, mass: 3.5}", false).expect("it is physical");
    assert!(robot.warnings.iter().any(|w| w.element == "payload" && w.message.contains("does not move")));
    let floating = load(&urdf(""), "payload: {link: base, mass: 3.5}", true).expect("it is physical");
    assert!(floating.warnings.is_empty(), "{:?}", floating.warnings);
}

#[test]
fn loads_that_no_body_is_are_refused() {
    for (payload, key, word) in [
        ("{link: flagne, mass: 1}", "payload.link", "`flange`"),
        ("{link: flange, mass: -1}", "payload.mass", "negative"),
        ("{link: flange, mass: 0, inertia: [1, 1, 1, 0, 0, 0]}", "payload.inertia", "no mass"),
        ("{link: flange, mass: 1, inertia: [1, 1, 2.1, 0, 0, 0]}", "payload.inertia", "triangle"),
        ("{link: flange, mass: 1, inertia: [1, 1, 1, 2, 0, 0]}", "payload.inertia", "negative principal moment"),
        ("{link: flange, mass: 1, com: [0, 0, 0]}", "payload.com", "not a known key"),
        ("{link: flange}", "payload.link", "`mass` is missing"),
    ] {
        let error = load(&urdf(""), &format!("payload: {payload}"), false).expect_err(payload);
        assert_eq!((error.element.as_str(), error.file.as_str()), (key, "robot.yaml:5"), "{error}");
        assert!(error.to_string().contains(word), "{error}");
    }
}
