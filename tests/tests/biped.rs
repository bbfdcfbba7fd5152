//! The recursions on the planar five-link biped against the closed forms of Mu and Wu (2004); equation numbers are theirs.

use gyroflex::dynamics::placements;
use gyroflex::model::{Fidelity, RobotSpec};
use gyroflex::spatial::{Transform, Vec3};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::robot::Robot;
use gyroflex_testkit::State as Point;
use gyroflex_testkit::biped::{
    Biped, Links, Planar, Stance, TrunkRooted, joint_rates, relabelled, relative_angles, segment_angles, segment_rates,
    segment_torques,
};
use gyroflex_testkit::random::random_point;
use gyroflex_testkit::tolerance::{assert_close, assert_close_above};
use gyroflex_tests::Core;
use nalgebra::{SMatrix, SVector};
use std::path::PathBuf;

const SEEDS: u64 = 1000;
const BIPED: Biped = Biped::MU_WU;

/// The chain on the pinned tip at random states, and each state as the paper has it.
fn for_states(law: impl Fn(&str, &Core<f64>, &Point, &PaperState)) {
    let bodies = BIPED.pinned_chain();
    let spec = RobotSpec { bodies: &bodies, spring_tables: &[], gravity: BIPED.chain_gravity() };
    let core = Core::<f64>::new(&spec, Fidelity::Complete);
    for seed in 0..SEEDS {
        let s = Point { tau_ext: Vec::new(), wrenches: Vec::new(), ..random_point(&bodies, &[], seed) };
        law(&format!("seed {seed}"), &core, &s, &PaperState::of(&s));
    }
}

/// Everything in the absolute angles.
struct PaperState {
    theta: Links,
    rate: Links,
    acceleration: Links,
    torque: Links,
}

impl PaperState {
    fn of(s: &Point) -> Self {
        Self {
            theta: segment_angles(&Links::from_column_slice(&s.q)),
            rate: segment_rates(&Links::from_column_slice(&s.qd)),
            acceleration: segment_rates(&Links::from_column_slice(&s.qdd)),
            torque: segment_torques(&Links::from_column_slice(&s.tau)),
        }
    }
}

/// Bias forces are differences of larger torques; this bounds those.
fn weight_at_full_stretch() -> f64 {
    BIPED.gravity * BIPED.mass.iter().sum::<f64>() * BIPED.length.iter().sum::<f64>()
}

#[test]
fn single_support_accelerates_as_in_equation_4() {
    for_states(|context, core, s, paper| {
        let want = joint_rates(&BIPED.single_support(&paper.theta, &paper.rate, &paper.torque));
        assert_close("aba", &context, &core.aba(s).qdd, want.as_slice(), 1e-12);
        assert_close("by the inertia matrix", &context, &core.forward_in_joint_space(s).qdd, want.as_slice(), 1e-12);
    });
}

#[test]
fn inverse_dynamics_and_bias_are_those_of_equation_28() {
    for_states(|context, core, s, paper| {
        let form = BIPED.relative_form(&relative_angles(&paper.theta), &joint_rates(&paper.rate));
        let want = form.inertia_matrix * joint_rates(&paper.acceleration) + form.bias;
        assert_close("rnea", &context, &core.inverse(s).tau_j, want.as_slice(), 1e-12);
        let [bias, _] = core.bias(s);
        assert_close_above("bias", &context, &bias, form.bias.as_slice(), 1e-12, weight_at_full_stretch());
        let gravity = BIPED.relative_form(&relative_angles(&paper.theta), &Links::zeros()).bias;
        let got = core.gravity(s);
        assert_close_above("gravity", &context, &got, gravity.as_slice(), 1e-12, weight_at_full_stretch());
    });
}

#[test]
fn inertia_matrix_is_that_of_equation_28() {
    for_states(|context, core, s, paper| {
        let form = BIPED.relative_form(&relative_angles(&paper.theta), &joint_rates(&paper.rate));
        assert_close("crba", &context, &core.mass_matrix(s), form.inertia_matrix.as_slice(), 1e-12);
    });
}

#[test]
fn energies_are_those_of_equations_2_and_3() {
    for_states(|context, core, s, paper| {
        let got = core.energy(s);
        let want = BIPED.kinetic(&paper.theta, &paper.rate);
        assert_close("kinetic energy", &context, &[got.kinetic], &[want], 1e-12);
        let want = BIPED.potential(&paper.theta.into());
        assert_close_above("potential", &context, &[got.gravity], &[want], 1e-12, weight_at_full_stretch());
    });
}

fn robot(name: &str) -> Robot {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots").join(name).join("robot.yaml");
    load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// Points of the robot in its plane: the tips `b` and `e` of the stance, the hip, and the centres of mass along the chain.
struct Places {
    tips: [Planar; 2],
    hip: Planar,
    centres: [Planar; 5],
}

/// By the recursion, from the files.
fn places(robot: &Robot, q: &[f64; 7], stance: Stance) -> Places {
    let model = robot.model(Fidelity::Complete).unwrap_or_else(|e| panic!("{e}"));
    let mut poses = vec![Transform::identity(); robot.bodies.len()];
    placements(&model.view(), q, &mut poses).expect("slices fit the model");
    let in_world = |body: usize, p: Vec3<f64>| poses[body].rotation() * p + poses[body].pos;
    let in_plane = |p: Vec3<f64>| Planar::new(p.x, p.z);
    let frame = |name: &str| {
        let link = robot.links.iter().find(|l| l.name == name).unwrap_or_else(|| panic!("no link {name}"));
        in_plane(in_world(link.body.expect("it moves"), link.placement.pos))
    };
    let centre = |name: &str| {
        let body = robot.joints.iter().position(|j| j.child_link == name).unwrap_or_else(|| panic!("no link {name}"));
        let inertia = &robot.bodies[body].inertia;
        in_plane(in_world(body, inertia.first_moment.scale(1.0 / inertia.mass)))
    };
    let [stands, swings] = if stance == Stance::Left { ["left", "right"] } else { ["right", "left"] };
    let part = |side: &str, part: &str| format!("{side}_{part}");
    Places {
        tips: [frame(&part(stands, "foot")), frame(&part(swings, "foot"))],
        hip: frame("torso"),
        centres: [
            centre(&part(stands, "shank")),
            centre(&part(stands, "thigh")),
            centre("torso"),
            centre(&part(swings, "thigh")),
            centre(&part(swings, "shank")),
        ],
    }
}

/// Random coordinates of the robot.
fn for_poses(robot: &Robot, law: impl Fn(&str, &Point, TrunkRooted, Stance)) {
    for seed in 0..SEEDS {
        let s = random_point(&robot.bodies, &robot.spring_tables, seed);
        let q = TrunkRooted(s.q.as_slice().try_into().expect("seven coordinates"));
        for stance in Stance::BOTH {
            law(&format!("{}, seed {seed}, {stance:?} stance", robot.name), &s, q, stance);
        }
    }
}

#[test]
fn tips_hip_and_centres_of_mass_are_where_equation_1_has_them_in_both_stances() {
    for name in ["biped5", "biped5_elastic"] {
        let robot = robot(name);
        for_poses(&robot, |context, _, q, stance| {
            let (got, theta) = (places(&robot, &q.0, stance), q.angles(stance));
            let [b, e] = got.tips;
            let seen = |what: &str, at: &Planar, want: [f64; 2]| {
                assert_close_above(what, &context, (at - b).as_slice(), &want, 1e-14, 1.0);
            };
            seen("tip", &e, BIPED.joint(5, &theta.into()));
            seen("hip", &got.hip, BIPED.joint(2, &theta.into()));
            for (i, centre) in got.centres.iter().enumerate() {
                seen("centre of mass", centre, BIPED.centre_of_mass(i, &theta.into()));
            }
            let outputs = BIPED.outputs(&theta, &Links::zeros()).value;
            let want = [outputs[0] + b[0], outputs[1] + b[1], outputs[2]];
            assert_close_above("outputs", &context, &q.0[..3], &want, 1e-14, 1.0);
            let back = TrunkRooted::from_angles(&BIPED, stance, &theta, &b);
            assert_close_above("coordinates", &context, &back.0, &q.0, 1e-14, 1.0);
        });
    }
}

/// What eq. 22 relabels is the stance.
#[test]
fn the_other_stance_is_the_paper_s_relabelling() {
    let robot = robot("biped5");
    for_poses(&robot, |context, _, q, stance| {
        let other = if stance == Stance::Left { Stance::Right } else { Stance::Left };
        let want = relabelled(&q.angles(stance));
        assert_close_above("angles", &context, q.angles(other).as_slice(), want.as_slice(), 1e-14, 1.0);
    });
}

/// While a tip rests, the robot's coordinates need the paper's joint torques, and what the ground does through that tip: its
/// force, which is all that bears the sliding joints, and the ankle's torque.
#[test]
fn torques_of_the_robot_in_single_support_are_the_paper_s() {
    let robot = robot("biped5");
    let core = Core::<f64>::new(&robot.spec(), Fidelity::Complete);
    for_poses(&robot, |context, s, q, stance| {
        let seven = |x: &[f64]| TrunkRooted(x.try_into().expect("seven coordinates"));
        let (theta, rate, acceleration) = (q.angles(stance), seven(&s.qd).rates(stance), seven(&s.qdd).rates(stance));
        let moving = Point {
            qd: TrunkRooted::from_rates(&BIPED, stance, &theta, &rate).0.to_vec(),
            qdd: TrunkRooted::from_accelerations(&BIPED, stance, &theta, &rate, &acceleration).0.to_vec(),
            tau_ext: Vec::new(),
            wrenches: Vec::new(),
            ..s.clone()
        };
        let got = core.inverse(&moving).tau_j;

        let form = BIPED.relative_form(&relative_angles(&theta), &joint_rates(&rate));
        let torque = form.inertia_matrix * joint_rates(&acceleration) + form.bias;
        let turning = SMatrix::<f64, 5, 7>::from_fn(|link, k| {
            TrunkRooted(core::array::from_fn(|j| if j == k { 1.0 } else { 0.0 })).rates(stance)[link]
        });
        let to_hip = BIPED.outputs(&theta, &rate).jacobian.fixed_rows::<2>(0) * turning;
        let tip = SMatrix::<f64, 2, 7>::identity() - to_hip;
        let through_tip = tip.transpose() * Planar::new(got[0], got[1]) + turning.row(0).transpose() * torque[0];
        let want = through_tip + SVector::from(TrunkRooted::from_joint_torques(stance, &torque).0);
        assert_close("torques", &context, &got, want.as_slice(), 1e-12);
        let back = TrunkRooted::from_joint_torques(stance, &torque).joint_torques(stance, torque[0]);
        assert_close("the paper's torques", &context, back.as_slice(), torque.as_slice(), 0.0);
    });
}

/// Rotors that do not turn with their joints leave the inertia matrix of the links.
#[test]
fn drives_leave_the_links_as_they_are() {
    let [ideal, elastic] = ["biped5", "biped5_elastic"].map(robot);
    let models = [(&ideal, Fidelity::Complete), (&elastic, Fidelity::Reduced)];
    for_poses(&ideal, |context, s, _, _| {
        let [want, got] = models.map(|(robot, model)| Core::<f64>::new(&robot.spec(), model).mass_matrix(s));
        assert_close("inertia matrix", &context, &got, &want, 1e-14);
    });
}
