//! Frames, fusing, order and floating roots.

use gyroflex::dynamics::{CrbaScratch, crba};
use gyroflex::model::{Fidelity, JointKind};
use gyroflex_sim::Robot;
use gyroflex_sim::load::{Embedded, LoadOptions, load_from, load_urdf_text};
use std::path::Path;

fn load(text: &str, floating: bool) -> Robot {
    load_urdf_text(text, "r.urdf", None, &LoadOptions { floating, ..LoadOptions::default() }).unwrap()
}

/// A link with an inertia that fills all ten numbers.
fn link(name: &str, mass: f64) -> String {
    format!(
        "<link name='{name}'><inertial><origin xyz='0.1 -0.2 {mass}' rpy='0.3 0.2 -0.5'/><mass value='{mass}'/>\
         <inertia ixx='0.5' ixy='0.02' ixz='-0.03' iyy='0.6' iyz='0.04' izz='0.7'/></inertial></link>\n"
    )
}

fn joint(name: &str, kind: &str, parent: &str, child: &str) -> String {
    format!(
        "<joint name='{name}' type='{kind}'><origin xyz='0.3 {} 0.5' rpy='0.7 -0.4 {}'/>\
         <parent link='{parent}'/><child link='{child}'/><axis xyz='1 2 -1'/></joint>\n",
        name.len(),
        parent.len()
    )
}

fn mass_matrix(robot: &Robot, q: &[f64]) -> Vec<Vec<f64>> {
    let model = robot.model(Fidelity::Complete).unwrap();
    let view = model.view();
    let n = view.nv();
    let mut scratch = vec![CrbaScratch::default(); view.bodies().len()];
    let mut m = vec![0.0; n * n];
    crba(&view, q, &mut scratch, &mut m).unwrap();
    m.chunks(n).map(<[f64]>::to_vec).collect()
}

#[track_caller]
fn assert_close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * (1.0 + a.abs().max(b.abs())), "{a} {b}");
}

#[test]
fn fusing_equals_a_joint_held_at_zero() {
    let links: String =
        [("base", 1.0), ("a", 2.0), ("b", 3.0), ("c", 1.5), ("d", 0.7)].map(|(n, m)| link(n, m)).concat();
    // `weld` and `weld2` are fixed in one robot and turn, held at zero, in the other.
    let text = |kind: &str| {
        format!(
            "<robot name='r'>{links}{}{}{}{}</robot>",
            joint("first", "revolute", "base", "a"),
            joint("weld", kind, "a", "b"),
            joint("weld2", kind, "b", "c"),
            joint("last", "prismatic", "c", "d")
        )
    };
    let (fused, free) = (load(&text("fixed"), false), load(&text("revolute"), false));
    assert_eq!((fused.bodies.len(), free.bodies.len()), (2, 4));
    let (small, large) = (mass_matrix(&fused, &[0.4, 0.2]), mass_matrix(&free, &[0.4, 0.0, 0.0, 0.2]));
    for (i, k) in [(0, 0), (1, 3)] {
        for (j, l) in [(0, 0), (1, 3)] {
            assert_close(small[i][j], large[k][l]);
        }
    }
    // The frames of fused links are kept: where `c` is in `a` equals two steps along the welds.
    let names: Vec<_> = fused.links.iter().map(|l| (l.name.as_str(), l.body)).collect();
    assert_eq!(names, [("base", None), ("a", Some(0)), ("b", Some(0)), ("c", Some(0)), ("d", Some(1))]);
    let steps = free.bodies[2].placement.after(free.bodies[1].placement);
    assert_eq!(fused.links[3].placement, steps);
    assert_eq!(fused.links[3].parent.as_deref(), Some("b"));
    assert_eq!(fused.bodies[1].parent, Some(0));
}

#[test]
fn mass_fused_to_a_fixed_root_belongs_to_the_world() {
    let links: String = [("base", 1.0), ("stand", 2.0), ("arm", 3.0)].map(|(n, m)| link(n, m)).concat();
    let text = format!(
        "<robot name='r'>{links}{}{}</robot>",
        joint("weld", "fixed", "base", "stand"),
        joint("turn", "continuous", "stand", "arm")
    );
    let fixed = load(&text, false);
    assert_eq!((fixed.bodies.len(), fixed.bodies[0].parent), (1, None));
    assert_eq!(fixed.bodies[0].placement, fixed.links[2].placement.after(fixed.bodies[0].placement));
    assert_eq!(fixed.links[1].body, None);

    let floating = load(&text, true);
    assert!(floating.is_floating() && !fixed.is_floating());
    assert_eq!((floating.bodies.len(), floating.bodies[0].joint), (2, JointKind::Floating));
    assert_eq!(floating.bodies[0].inertia.mass, 3.0, "base and stand");
    assert_eq!(floating.links[1].body, Some(0));
    assert_eq!((floating.joints[0].name.as_str(), floating.joints[0].parent_link.as_str()), ("root", "world"));
    let (small, large) =
        (mass_matrix(&fixed, &[0.3]), mass_matrix(&floating, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.3]));
    assert_close(small[0][0], large[6][6]);
    assert_close(large[3][3], 6.0);
}

#[test]
fn joints_come_depth_first_and_in_the_order_of_the_file() {
    let links: String = ["root_link", "z1", "z2", "a1", "a2"].map(|n| link(n, 1.0)).concat();
    // The file lists a child's joint before its parent's, and `z` before `a`.
    let text = format!(
        "<robot name='r'>{links}{}{}{}{}</robot>",
        joint("z_far", "revolute", "z1", "z2"),
        joint("z_near", "revolute", "root_link", "z1"),
        joint("a_near", "revolute", "root_link", "a1"),
        joint("a_far", "revolute", "a1", "a2")
    );
    let robot = load(&text, false);
    let order: Vec<_> = robot.joints.iter().map(|j| j.name.as_str()).collect();
    assert_eq!(order, ["z_near", "z_far", "a_near", "a_far"]);
    let parents: Vec<_> = robot.bodies.iter().map(|b| b.parent).collect();
    assert_eq!(parents, [None, Some(0), None, Some(2)]);
}

/// The pose of a joint with this `rpy`, as a rotation matrix that takes child coordinates to parent coordinates.
fn rotation(rpy: &str) -> [[f64; 3]; 3] {
    let text = format!(
        "<robot name='r'><link name='a'/>{}<joint name='j' type='revolute'><origin rpy='{rpy}'/><parent link='a'/>\
         <child link='b'/><axis xyz='0 0 1'/></joint></robot>",
        link("b", 1.0)
    );
    let rows = load(&text, false).bodies[0].placement.rotation().rows;
    rows.map(|r| r.to_array())
}

#[test]
fn rpy_turns_about_fixed_axes_roll_first() {
    let (r, p, y) = (0.3_f64, -0.8_f64, 2.1_f64);
    let m = rotation("0.3 -0.8 2.1");
    // Rz(y) Ry(p) Rx(r): its first column and last row in closed form.
    assert_close(m[0][0], y.cos() * p.cos());
    assert_close(m[1][0], y.sin() * p.cos());
    assert_close(m[2][0], -p.sin());
    assert_close(m[2][1], p.cos() * r.sin());
    assert_close(m[2][2], p.cos() * r.cos());
}

#[test]
fn right_angles_are_exact_and_their_abbreviations_are_not() {
    assert_eq!(rotation("1.5707963267948966 0 0"), [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]);
    assert_eq!(rotation("0 -1.5707963267948966 0"), [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]);
    assert_eq!(
        rotation("3.141592653589793 0 -3.141592653589793"),
        [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]
    );
    assert_eq!(
        rotation("1.5707963267948966 1.5707963267948966 0"),
        [[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]]
    );
    for written in ["1.5708", "1.57079632679"] {
        let angle: f64 = written.parse().unwrap();
        // Not rounded to zero: equal to the platform's cosine but for the last places of both.
        let (got, want) = (rotation(&format!("{written} 0 0"))[1][1], angle.cos());
        assert!((got - want).abs() <= 4.0 * f64::EPSILON * want.abs(), "{got:e} for {want:e}");
    }
}

#[test]
fn axes_are_normalised_and_default_to_x() {
    let text = |axis: &str| {
        format!(
            "<robot name='r'><link name='a'/>{}<joint name='j' type='continuous'><parent link='a'/><child link='b'/>{axis}</joint></robot>",
            link("b", 1.0)
        )
    };
    let axis = |a: &str| load(&text(a), false).bodies[0].axis.to_array();
    assert_eq!(axis(""), [1.0, 0.0, 0.0]);
    assert_eq!(axis("<axis xyz='0 -3 4'/>"), [0.0, -0.6, 0.8]);
    assert_eq!(axis("<axis xyz='0 0 1e-200'/>"), [0.0, 0.0, 1.0]);
}

#[test]
fn forgiving_where_other_tools_are() {
    let body = format!(
        "<link name='a'/>{}<joint name='j' type='prismatic'><drake:gear_ratio value='2'/><parent link='a'/><child link='b'/>\
         <limit effort='0' upper='1'/></joint>",
        link("b", 1.0)
    );
    // Blanks and a byte order mark before the declaration, an undeclared prefix, no robot name, a limit without velocity.
    let text = format!(
        "\u{feff}\n\n<?xml version='1.0'?><!-- <robot> -->\n<robot xmlns:xacro='http://ros.org/wiki/xacro'>{body}</robot>"
    );
    let robot = load(&text, false);
    assert_eq!((robot.name.as_str(), robot.joints[0].limits), ("r", Some([0.0, 1.0])));
    assert_eq!((robot.joints[0].max_torque, robot.joints[0].max_velocity), (None, None));
    let idle = robot.warnings.iter().find(|w| w.message.contains("gear ratio")).unwrap();
    assert_eq!(idle.file, "r.urdf:5", "lines count from the start of the file");
}

#[test]
fn robots_in_memory_load_like_robots_on_disk() {
    const URDF: &str = "<robot name='r'><link name='a'/><link name='b'><inertial><mass value='1'/>\
        <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
        <joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>";
    const YAML: &str = "urdf: ../urdf/r.urdf\nmodel: reduced\n";
    const FILES: Embedded = Embedded(&[("bots/yaml/robot.yaml", YAML), ("bots/urdf/r.urdf", URDF)]);
    let memory = load_from(&FILES, Path::new("bots/yaml/robot.yaml"), &LoadOptions::default()).unwrap();

    let folder = std::env::temp_dir().join(format!("gyroflex-load-{}", std::process::id()));
    for (name, text) in FILES.0 {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    let disk = gyroflex_sim::load::load(&folder.join("bots/yaml/robot.yaml"), &LoadOptions::default()).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!((memory.fidelity, memory.joints.len()), (Fidelity::Reduced, 1));
    assert_eq!(format!("{memory:?}"), format!("{disk:?}"));
}
