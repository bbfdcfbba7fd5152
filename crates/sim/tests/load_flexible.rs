//! Links that bend, from files: integrals, stations, seats and inertias, and one error for everything that cannot be.

use gyroflex::model::{Fidelity, FlexibleRecords};
use gyroflex::spatial::{SpatialInertia, Vec3};
use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::flexible::{Flexure, Place};
use gyroflex_sim::load::{LoadOptions, load, load_urdf_text};
use gyroflex_sim::robot::Robot;
use nalgebra::DMatrix;
use std::path::Path;

/// An arm of two turning links, a flange and a sensor fixed on the way, and a finger on the flange.
fn urdf() -> String {
    let link = |name: &str, mass: f64| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0.3 0 0'/><mass value='{mass}'/>\
             <inertia ixx='0.01' iyy='0.02' izz='0.02' ixy='0' ixz='0' iyz='0'/></inertial></link>"
        )
    };
    let joint = |name: &str, kind: &str, parent: &str, child: &str, at: &str| {
        format!(
            "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/><origin xyz='{at}'/>\
             <axis xyz='0 0 1'/></joint>"
        )
    };
    [
        "<robot name='r'>".to_owned(),
        ["base", "upper", "lower", "finger"].map(|name| link(name, 1.0)).concat(),
        link("sensor", 0.1),
        link("flange", 0.2),
        "<link name='stand'/>".to_owned(),
        joint("s", "fixed", "base", "stand", "0 0 0"),
        joint("shoulder", "revolute", "base", "upper", "0 0 0.5"),
        joint("elbow", "revolute", "upper", "lower", "0.8 0.1 0.2"),
        joint("a", "fixed", "upper", "sensor", "0.4 0.05 0"),
        joint("b", "fixed", "lower", "flange", "0.9 0 0.1"),
        joint("grip", "prismatic", "flange", "finger", "-0.3 0 0"),
        "</robot>".to_owned(),
    ]
    .concat()
}

const BEAM: &str = "length: 0.8, mass_per_length: 1.25, bending_y: {stiffness: 10, modes: 2, damping: 0.01}";

fn options() -> LoadOptions {
    LoadOptions::default()
}

fn read(links: &str, more: &str) -> Result<Robot, Error> {
    let yaml = format!("urdf: r.urdf\nflexible_links:\n{links}\n{more}\n");
    load_urdf_text(&urdf(), "r.urdf", Some(&yaml), &options())
}

fn upper(entry: &str) -> Result<Robot, Error> {
    read(&format!("  upper: {{{entry}}}"), "")
}

#[track_caller]
fn refused(result: Result<Robot, Error>, element: &str, words: &[&str]) {
    let e = result.expect_err("this must be refused");
    assert_eq!(e.kind, ErrorKind::Yaml, "{e}");
    assert_eq!((e.file.as_str(), e.element.as_str()), ("robot.yaml:3", element), "{e}");
    assert!(!e.remedy.is_empty(), "{e}");
    let text = e.to_string();
    words.iter().for_each(|word| assert!(text.contains(word), "no {word:?} in: {text}"));
}

fn close(is: f64, want: f64, tolerance: f64) {
    assert!((is - want).abs() <= tolerance, "{is} is not {want} to {tolerance}");
}

fn near(is: Vec3<f64>, want: [f64; 3], tolerance: f64) {
    is.to_array().iter().zip(want).for_each(|(is, want)| close(*is, want, tolerance));
}

fn same(is: SpatialInertia<f64>, want: SpatialInertia<f64>) {
    close(is.mass, want.mass, 1e-12);
    near(is.first_moment, want.first_moment.to_array(), 1e-12);
    let (a, b) = (is.rotational.to_mat3(), want.rotational.to_mat3());
    a.rows.iter().zip(b.rows).for_each(|(a, b)| near(*a, b.to_array(), 1e-12));
}

fn station<'a>(flexure: &'a Flexure, name: &str) -> &'a gyroflex_sim::flexible::StationInfo {
    flexure.stations.iter().find(|s| s.name == name).unwrap_or_else(|| panic!("no station {name}"))
}

#[test]
fn a_robot_without_flexible_links_has_none() {
    let robot = load_urdf_text(&urdf(), "r.urdf", None, &options()).unwrap();
    assert!(robot.flexible.is_empty() && robot.flexible.seats.is_empty());
}

#[test]
fn the_beam_replaces_the_inertia_of_the_urdf() {
    let robot = upper(BEAM).unwrap();
    let flexure = &robot.flexible.links[0];
    let beam = SpatialInertia::from_com(
        1.0,
        Vec3::new(0.4, 0.0, 0.0),
        gyroflex::spatial::SymMat3::diagonal(0.0, 0.64 / 12.0, 0.64 / 12.0),
    );
    same(flexure.inertia, beam);
    let sensor = station(flexure, "upper.sensor").inertia;
    close(sensor.mass, 0.1, 0.0);
    near(sensor.first_moment, [0.07, 0.005, 0.0], 1e-15);
    same(robot.bodies[0].inertia, beam + sensor);
    assert!(!robot.warnings.iter().any(|w| w.message.contains("kg")), "{:?}", robot.warnings);
}

#[test]
fn masses_that_differ_from_the_urdf_are_told() {
    let robot = upper(&BEAM.replace("1.25", "1.3")).unwrap();
    let warning = robot.warnings.iter().find(|w| w.element == "flexible_links.upper").expect("there is a warning");
    assert_eq!(warning.file, "robot.yaml:3");
    assert!(warning.message.contains("weigh 1.04 kg") && warning.message.contains("1 kg (r.urdf:"), "{warning}");
}

#[test]
fn everything_on_a_link_sits_on_a_station() {
    let robot = read(
        &format!("  upper: {{{BEAM}, masses: [{{at: 0.4, mass: 0.3}}, {{at: tip, mass: 0.2, inertia: 0.01}}]}}\n  lower: {{{BEAM}}}"),
        "drives:\n  elbow: {rotor: {inertia: 1e-4, mass: 0.5}}\n  grip: {rotor: {inertia: 1e-5, mount: {link: flange, xyz: [0, 0, 0.1], axis: [1, 0, 0]}}}",
    )
    .unwrap();
    let names: Vec<&str> = robot.flexible.station_names().collect();
    // The sensor shares the place of the mass; elbow and rotor are at the tip, beside the axis.
    assert_eq!(names, ["upper.tip", "upper.mass1", "lower.tip"]);
    let [upper, lower] = [0, 1].map(|i| &robot.flexible.links[i]);
    close(station(upper, "upper.mass1").inertia.mass, 0.4, 1e-15);
    close(station(upper, "upper.tip").inertia.mass, 0.2, 0.0);
    // The finger hangs on the flange, and so moves with the flange's cross-section, not with the one it is next to.
    close(station(lower, "lower.tip").inertia.mass, 0.2, 0.0);
    let tip = |link: usize| Some(Place { link, station: 0 });
    let seats: Vec<_> = robot.flexible.seats.iter().map(|s| (s.joint, s.rotor)).collect();
    assert_eq!(seats, [(None, None), (tip(0), tip(0)), (tip(1), tip(1))]);
    for (flexure, body) in robot.flexible.links.iter().zip([0, 1]) {
        same(robot.bodies[body].inertia, flexure.total_inertia());
    }
    let tables = robot.flexible.tables();
    assert_eq!(tables.seats.iter().map(|s| s.parent).collect::<Vec<_>>(), [None, Some(0), Some(2)]);
    assert_eq!((tables.modes.len(), tables.pairs.len(), tables.shapes.len()), (4, 8, 6));
}

#[test]
fn names_say_link_kind_and_number() {
    let robot = upper(&format!(
        "{BEAM}, polar_inertia_per_length: 1e-4, bending_z: {{stiffness: 8}}, torsion: {{stiffness: 5}}, extension: {{stiffness: 1e5}}"
    ))
    .unwrap();
    let names: Vec<&str> = robot.flexible.mode_names().collect();
    assert_eq!(
        names,
        ["upper.bending_y1", "upper.bending_y2", "upper.bending_z1", "upper.torsion1", "upper.extension1"]
    );
    let shapes: Vec<_> = (0..5).map(|j| robot.flexible.links[0].shape(j, 0.8)).collect();
    // Bending along y turns the tip about z, along z about −y.
    assert!(shapes[0].displacement.y > 0.0 && shapes[0].rotation.z > 0.0);
    assert!(shapes[2].displacement.z > 0.0 && shapes[2].rotation.y < 0.0);
    assert!(shapes[3].rotation.x > 0.0 && shapes[3].displacement == Vec3::zero());
    assert!(shapes[4].displacement.x > 0.0 && shapes[4].rotation == Vec3::zero());
}

#[test]
fn the_core_takes_the_records() {
    let links = format!(
        "  upper: {{{BEAM}, geometric_stiffening: true, hub: {{mass: 1, inertia: 0.01}}}}\n  lower: {{{BEAM}, torsion: {{stiffness: 3}}, polar_inertia_per_length: 1e-3}}"
    );
    let robot = read(&links, "payload: {link: flange, mass: 2}").unwrap();
    let mut tables = robot.flexible.tables();
    let records: FlexibleRecords<'_> = tables.records();
    let model = robot.model(Fidelity::Complete).unwrap();
    let model = records.lower(&robot.spec(), model.view()).unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!((model.modes(), model.nv()), (5, 8));
}

#[test]
fn a_turned_beam_has_the_same_integrals_in_other_axes() {
    let straight = upper(BEAM).unwrap();
    let turned = upper(&format!("{BEAM}, origin: {{xyz: [0.1, 0.2, 0.3], rpy: [0, 0, 1.5707963267948966]}}")).unwrap();
    let [a, b] = [&straight, &turned].map(|r| &r.flexible.links[0].integrals);
    let (m, n) = (a.modes[0], b.modes[0]);
    near(n.momentum, [-m.momentum.y, 0.0, 0.0], 1e-15);
    // ∫ x φᵀ dm with x = root + ξ e_y and φ = −φ e_x
    near(n.moments.rows[0], [-0.1 * m.momentum.y, 0.0, 0.0], 1e-15);
    near(n.moments.rows[1], [-0.2 * m.momentum.y - m.moments.rows[0].y, 0.0, 0.0], 1e-15);
    close(b.pairs[0].moments.rows[0].x, a.pairs[0].moments.rows[1].y, 1e-15);
    near(turned.flexible.links[0].position(0.8), [0.1, 1.0, 0.3], 1e-15);
}

#[test]
fn loads_sit_on_stations_and_come_off_again() {
    let bare = read(&format!("  lower: {{{BEAM}}}"), "").unwrap();
    let mut loaded = read(&format!("  lower: {{{BEAM}}}"), "payload: {link: flange, mass: 2}").unwrap();
    close(station(&loaded.flexible.links[0], "lower.tip").inertia.mass, 2.2, 1e-15);
    same(loaded.bodies[1].inertia, loaded.flexible.links[0].total_inertia());
    loaded.set_payload(None);
    same(loaded.bodies[1].inertia, bare.bodies[1].inertia);
    close(station(&loaded.flexible.links[0], "lower.tip").inertia.mass, 0.2, 0.0);
    // On the link itself it is where it is.
    let beside = read(&format!("  lower: {{{BEAM}}}"), "payload: {link: lower, mass: 2, xyz: [0.5, 0.1, 0]}").unwrap();
    close(station(&beside.flexible.links[0], "lower.payload").x, 0.5, 1e-15);
}

#[test]
fn shapes_from_tables_are_modes_with_their_own_frequency() {
    let table = "table: [[0, 0, 0], [0.4, 0.3, 1.4], [0.8, 1, 1.9]]";
    let robot = upper(&format!(
        "length: 0.8, mass_per_length: 1.25, bending_y: {{shapes: [{{{table}, frequency: 3}}], damping: 0.02}}"
    ))
    .unwrap();
    let flexure = &robot.flexible.links[0];
    let (pair, mode) = (flexure.integrals.pairs[0], &flexure.modes[0]);
    let omega = 2.0 * std::f64::consts::PI * 3.0;
    close(pair.stiffness, omega * omega * pair.moments.trace(), 1e-10);
    close(pair.damping, 2.0 * 0.02 * omega * pair.moments.trace(), 1e-12);
    close(mode.figures.frequency, 3.0, 1e-12);
    near(flexure.shape(0, 0.4).displacement, [0.0, 0.3, 0.0], 1e-15);
    near(flexure.shape(0, 0.8).rotation, [0.0, 0.0, 1.9], 1e-14);
    // Masses of the link count in the generalised mass of a tool: with 0.5 kg where the shape is one, half a kilogram more.
    let heavy = format!(
        "length: 0.8, mass_per_length: 1.25, masses: [{{at: tip, mass: 0.5}}], bending_y: {{shapes: [{{{table}, frequency: 3}}]}}"
    );
    let figures = upper(&heavy).unwrap().flexible.links[0].modes[0].figures;
    close(figures.total_mass, pair.moments.trace() + 0.5, 1e-12);
    close(figures.stiffness, omega * omega * figures.total_mass, 1e-9);
}

#[test]
fn the_shipped_arms_have_the_frequencies_of_their_readmes() {
    let shipped = |file: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(file);
        load(&path, &options()).unwrap_or_else(|e| panic!("{e}"))
    };
    let frequencies = |robot: &Robot| -> Vec<f64> {
        robot.flexible.links.iter().flat_map(|l| &l.modes).map(|m| m.figures.frequency).collect()
    };
    for (file, want) in [("robot", [2.50, 15.68]), ("stiff", [7.91, 49.59]), ("elastic", [2.50, 15.68])] {
        let robot = shipped(&format!("book_two_link/{file}.yaml"));
        assert!(robot.warnings.is_empty(), "{:?}", robot.warnings);
        let found = frequencies(&robot);
        found.iter().zip(want.iter().chain(&want)).for_each(|(is, want)| close(*is, *want, 0.006));
    }
    for file in ["clamped", "clamped_stiff"] {
        let robot = shipped(&format!("book_two_link/{file}.yaml"));
        let shape = robot.flexible.links[0].shape(1, 1.0);
        close(shape.displacement.norm() + shape.rotation.norm(), 0.0, 1e-12);
    }
    // De Luca & Siciliano 1991, as printed: φ_e, φ'_e, v, w, f.
    let robot = shipped("deluca_siciliano/robot.yaml");
    assert!(robot.warnings.is_empty(), "{:?}", robot.warnings);
    let printed = [
        [0.186, 0.657, 0.007, 0.002, 0.48],
        [0.215, -0.560, 0.013, 0.004, 1.80],
        [0.883, 2.641, 0.033, 0.012, 2.18],
        [-0.069, -10.853, 0.054, 0.016, 15.91],
    ];
    for (k, [value, slope, v, w, f]) in printed.into_iter().enumerate() {
        let (flexure, j) = (&robot.flexible.links[k / 2], k % 2);
        let (shape, mode) = (flexure.shape(j, 0.5), flexure.integrals.modes[j]);
        close(shape.displacement.y, value, 0.0006);
        close(shape.rotation.z, slope, 0.0006);
        close(mode.momentum.y, v, 0.0006);
        close(mode.moments.rows[0].y, w, 0.0006);
        close(flexure.modes[j].figures.frequency, f, 0.006);
    }
}

#[test]
fn a_floating_root_may_bend() {
    let yaml = format!("urdf: r.urdf\nfloating: true\nflexible_links: {{base: {{{BEAM}}}}}\n");
    let robot = load_urdf_text(&urdf(), "r.urdf", Some(&yaml), &options()).unwrap();
    assert_eq!(robot.flexible.links[0].body, 0);
}

#[test]
fn links_that_cannot_bend_are_refused() {
    refused(read(&format!("  uper: {{{BEAM}}}"), ""), "flexible_links.uper", &["no link `uper`", "`upper`"]);
    refused(
        read(&format!("  base: {{{BEAM}}}"), ""),
        "flexible_links.base",
        &["fixed to the world", "that a joint moves"],
    );
    refused(
        read(&format!("  flange: {{{BEAM}}}"), ""),
        "flexible_links.flange",
        &["fixed to link `lower`", "let `lower` bend"],
    );
    refused(upper("length: 1, mass_per_length: 1"), "flexible_links.upper", &["no modes", "`bending_y`"]);
}

#[test]
fn numbers_that_no_beam_has_are_refused() {
    let cases = [
        (BEAM.replace("0.8", "0"), "length", "positive"),
        (BEAM.replace("0.8", "-1"), "length", "positive"),
        (BEAM.replace("1.25", "0"), "mass_per_length", "positive"),
        (BEAM.replace("1.25", "[[0, 1], [0.8, -1]]"), "mass_per_length", "positive"),
        (BEAM.replace("1.25", "[[0, 1]]"), "mass_per_length", "two points"),
        (BEAM.replace("1.25", "[[0, 1], [0.7, 1]]"), "mass_per_length", "to x = 0.7 m"),
        (
            BEAM.replace("1.25", "[[0, 1], [0.5, 1], [0.4, 1], [0.8, 1]]"),
            "mass_per_length",
            "x = 0.4 m comes after x = 0.5 m",
        ),
        (BEAM.replace("stiffness: 10", "stiffness: 0"), "bending_y.stiffness", "positive"),
        (BEAM.replace("stiffness: 10", "stiffness: [[0, 1], [0.8, 0]]"), "bending_y.stiffness", "positive"),
        (BEAM.replace("stiffness: 10, ", ""), "bending_y", "give E I [N m²]"),
        (BEAM.replace("modes: 2", "modes: 0"), "bending_y.modes", "between 1 and 64"),
        (BEAM.replace("modes: 2", "modes: 65"), "bending_y.modes", "between 1 and 64"),
        (BEAM.replace("0.01", "-0.01"), "bending_y.damping", "negative"),
        (BEAM.replace("0.01", "[0.1]"), "bending_y.damping", "1 damping ratios stand beside 2 modes"),
        (BEAM.replace("modes: 2", "boundary: clamped_mass"), "bending_y.boundary", "add `tip:"),
        (BEAM.replace("modes: 2", "tip: {mass: 1}"), "bending_y.tip", "only `clamped_mass` reads it"),
        (BEAM.replace("modes: 2", "boundary: clamped_mass, tip: {mass: -1}"), "bending_y.tip.mass", "negative"),
        (
            BEAM.replace("modes: 2", "boundary: clamped_mass, tip: {mass: 1, inertia: 0.01, first_moment: 0.2}"),
            "bending_y.tip.inertia",
            "about the tip",
        ),
        (
            format!("{BEAM}, extension: {{stiffness: 1, boundary: pinned_pinned}}"),
            "extension.boundary",
            "pins are for bending",
        ),
        (format!("{BEAM}, torsion: {{stiffness: 1}}"), "torsion.modes", "polar_inertia_per_length"),
        (format!("{BEAM}, polar_inertia_per_length: -1"), "polar_inertia_per_length", "negative"),
        (format!("{BEAM}, hub: {{mass: -1}}"), "hub.mass", "negative"),
        (format!("{BEAM}, hub: {{mass: 1, inertia: [1, 1, 3, 0, 0, 0]}}"), "hub.inertia", "triangle"),
        (format!("{BEAM}, masses: [{{at: 0.9, mass: 1}}]"), "masses[0].at", "0.9 m is not on the beam"),
        (format!("{BEAM}, masses: [{{at: tip, mass: -1}}]"), "masses[0].mass", "negative"),
    ];
    for (entry, key, word) in cases {
        refused(upper(&entry), &format!("flexible_links.upper.{key}"), &[word]);
    }
}

#[test]
fn so_few_points_that_the_highest_mode_suffers_are_refused() {
    let entry = |points: usize| format!("{}, quadrature_points: {points}", BEAM.replace("modes: 2", "modes: 6"));
    let e = upper(&entry(9)).expect_err("nine points are too few for six modes");
    assert_eq!(e.element, "flexible_links.upper.quadrature_points");
    let needed = e
        .remedy
        .split_whitespace()
        .find_map(|w| w.trim_end_matches(',').parse::<usize>().ok())
        .expect("it says how many");
    assert!(upper(&entry(needed - 1)).is_err());
    assert!(upper(&entry(needed)).is_ok());
}

#[test]
fn shapes_that_do_not_fit_are_refused() {
    let shapes = |shapes: &str, more: &str| {
        upper(&format!("length: 0.8, mass_per_length: 1.25, bending_y: {{stiffness: 10, shapes: [{shapes}]{more}}}"))
    };
    let good = "{table: [[0, 0, 0], [0.4, 0.3, 1.4], [0.8, 1, 1.9]]}";
    assert!(shapes(good, "").is_ok());
    let cases = [
        ("{table: [[0, 0.1], [0.4, 0.3], [0.8, 1]]}", "shapes[0].table", "displacement at the root"),
        ("{table: [[0, 0, 0.5], [0.4, 0.3, 1.4], [0.8, 1, 1.9]]}", "shapes[0].table", "slope at the root"),
        ("{table: [[0, 0], [0.2, 0.25], [0.4, 0.5], [0.8, 1]]}", "shapes[0].table", "slope at the root"),
        ("{table: [[0, 0], [0.4, 0.3, 1], [0.8, 1]]}", "shapes[0].table", "two or of three"),
        ("{table: [[0, 0], [0.4, 0.3], [0.7, 1]]}", "shapes[0].table", "to x = 0.7 m"),
        ("{table: [[0, 0], [0.4, 0], [0.8, 0]]}", "shapes[0].table", "zero everywhere"),
        ("{table: [[0, 0, 0], [0.8, 1, 1.9]], frequency: 0}", "shapes[0].frequency", "positive"),
        ("{table: [[0, 0, 0], [0.8, 1, 1.9]], modal_mass: 7}", "shapes[0].modal_mass", "multiply the shape by"),
    ];
    for (shape, key, word) in cases {
        refused(shapes(shape, ""), &format!("flexible_links.upper.bending_y.{key}"), &[word]);
    }
    let of = |key: &str| format!("flexible_links.upper.bending_y{key}");
    refused(shapes(good, ", modes: 2"), &of(".modes"), &["no effect beside `shapes`"]);
    refused(shapes("", ""), &of(".shapes"), &["no shapes"]);
    refused(shapes(good, ", boundary: clamped_clamped"), &of(".shapes[0].table"), &["displacement at the tip"]);
    refused(shapes(&format!("{good}, {good}"), ""), &of(""), &["`bending_y2` is a sum of the modes before it"]);
    let bare = "length: 0.8, mass_per_length: 1.25, bending_y: {shapes: [{table: [[0, 0], [0.4, 0.3], [0.8, 1]]}]}";
    refused(upper(bare), &of(""), &["`stiffness` is missing"]);
}

#[test]
fn unknown_keys_and_words_name_the_nearest() {
    for (entry, near) in [
        (BEAM.replace("mass_per_length", "mass_per_lenght"), "mass_per_length"),
        (BEAM.replace("modes: 2", "boundary: clamped_fre"), "clamped_free"),
        (BEAM.replace("bending_y", "bending_x"), "bending_y"),
    ] {
        let e = upper(&entry).expect_err("it is misspelt");
        assert!(e.remedy.contains(&format!("`{near}`")), "{e}");
    }
    let e = upper(&BEAM.replace("1.25", "heavy")).expect_err("it is no number");
    assert!(e.to_string().contains("a number, or a table"), "{e}");
}

#[test]
fn a_heavier_link_is_one_read_from_a_heavier_file() {
    let entry = |mass: f64, lump: f64| {
        format!(
            "  lower: {{length: 0.8, mass_per_length: {mass}, geometric_stiffening: true, masses: [{{at: 0.3, mass: {lump}}}], \
             bending_y: {{stiffness: 10, modes: 2}}}}"
        )
    };
    let read = |entry: String| {
        let yaml =
            format!("urdf: r.urdf\nflexible_links:\n{entry}\npayload: {{link: flange, mass: 2, xyz: [0, 0, 0.1]}}\n");
        // The flange is part of the link's mass as well.
        let urdf = urdf().replace("<mass value='0.2'/>", "<mass value='0'/>");
        load_urdf_text(&urdf, "r.urdf", Some(&yaml), &options()).unwrap()
    };
    let (mut scaled, heavy) = (read(entry(1.0, 0.5)), read(entry(1.5, 0.75)));
    let flange = SpatialInertia { mass: 0.0, ..station(&heavy.flexible.links[0], "lower.tip").inertia };
    assert!(scaled.scale_mass(1, 1.5));
    let [a, b] = [&scaled, &heavy].map(|r| &r.flexible.links[0]);
    for (a, b) in a.integrals.pairs.iter().zip(&b.integrals.pairs) {
        close(a.moments.trace(), b.moments.trace(), 1e-12);
        close(a.stiffness, b.stiffness, 1e-9);
        near(a.shortening, b.shortening.to_array(), 1e-12);
    }
    same(a.inertia, b.inertia);
    close(station(a, "lower.mass1").inertia.mass, 0.75, 1e-12);
    close(station(a, "lower.tip").inertia.mass, 2.0 + flange.mass, 1e-12);
    same(scaled.bodies[1].inertia, a.total_inertia());
    a.modes.iter().zip(&b.modes).for_each(|(a, b)| close(a.figures.frequency, b.figures.frequency, 1e-9));
}

#[test]
fn rigidly_geared_rotors_far_from_their_joints_are_refused() {
    let drive = |transmission: &str| {
        let mount = "mount: {link: upper, axis: [0, 0, 1]}";
        read(
            &format!("  lower: {{{BEAM}}}"),
            &format!("drives: {{grip: {{rotor: {{inertia: 1e-4, {mount}}}, transmission: {transmission}}}}}"),
        )
    };
    let e = drive("rigid").expect_err("it is remote and rigid");
    assert_eq!((e.file.as_str(), e.element.as_str()), ("robot.yaml:4", "drives.grip.rotor.mount"), "{e}");
    assert!(e.problem.contains("gear is rigid") && e.remedy.contains("parent link"), "{e}");
    assert!(drive("{stiffness: 100}").is_ok());
}

#[test]
fn free_modes_with_a_mass_at_their_tip_come_down_to_the_modes_of_the_loaded_beam() {
    let (mass, inertia) = (0.9, 0.02);
    let entry = |modes: &str, masses: &str| {
        format!("length: 0.8, mass_per_length: 1.25, bending_y: {{stiffness: 10, {modes}}}, masses: [{masses}]")
    };
    let loaded =
        upper(&entry(&format!("boundary: clamped_mass, tip: {{mass: {mass}, inertia: {inertia}}}, modes: 2"), ""));
    let want: Vec<f64> = loaded.unwrap().flexible.links[0].modes.iter().map(|m| m.figures.frequency).collect();
    let lump = format!("{{at: tip, mass: {mass}, inertia: {inertia}}}");
    let mut before = [f64::INFINITY; 2];
    for n in [2, 4, 8, 16] {
        let robot = upper(&entry(&format!("modes: {n}"), &lump)).unwrap();
        let tables = robot.flexible.tables();
        let shape = |j: usize| (tables.shapes[j].displacement.y, tables.shapes[j].rotation.z);
        let with_lump = DMatrix::from_fn(n, n, |j, k| {
            let ((u, psi), (v, chi)) = (shape(j), shape(k));
            tables.pairs[j * n + k].moments.trace() + mass * u * v + inertia * psi * chi
        });
        let stiffness = DMatrix::from_fn(n, n, |j, k| tables.pairs[j * n + k].stiffness);
        // K η = ω² M η by the Cholesky factor of M.
        let inverse = with_lump.cholesky().expect("it is positive").l().try_inverse().expect("it is triangular");
        let mut squares: Vec<f64> =
            (&inverse * stiffness * inverse.transpose()).symmetric_eigenvalues().as_slice().to_vec();
        squares.sort_by(f64::total_cmp);
        let found = [0, 1].map(|i| squares[i].sqrt() / (2.0 * std::f64::consts::PI));
        for (i, is) in found.into_iter().enumerate() {
            // Rayleigh and Ritz: from above, and the closer the more modes there are.
            assert!(is > want[i] && is <= before[i], "{n} modes: {is} Hz, the beam has {} Hz", want[i]);
        }
        before = found;
    }
    // Slowly: free modes have no moment at the tip, and the loaded beam has one there.
    before.iter().zip(&want).for_each(|(is, want)| close(is / want, 1.0, 0.05));
}
