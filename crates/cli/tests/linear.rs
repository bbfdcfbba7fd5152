//! The commands about linear models: what they print, what they write, and what they refuse.

mod process;

use process::{Ended, folder, gyroflex, pendulum, project, write};
use serde_json::Value;

/// Inertia of the bob about the hinge [kg m²], and torque of gravity on it when horizontal [N m].
const INERTIA: f64 = 0.01 + 0.25;
const WEIGHT: f64 = 9.81 * 0.5;

fn json(ended: &Ended) -> Value {
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    serde_json::from_str(&ended.out).expect("--json prints JSON")
}

fn close(got: &Value, want: f64) {
    let got = got.as_f64().expect("a number");
    assert!((got - want).abs() <= 1e-9 * want.abs(), "{got} instead of {want}");
}

#[test]
fn a_pendulum_hangs_at_its_frequency() {
    let here = pendulum("modes_pendulum");
    let printed = json(&gyroflex(&here, &["modes", "pendulum.urdf", "--json"]));
    let modes = printed["modes"].as_array().expect("a list");
    assert_eq!(modes.len(), 1);
    close(&modes[0]["frequency"], (WEIGHT / INERTIA).sqrt() / std::f64::consts::TAU);
    let table = gyroflex(&here, &["modes", "pendulum.urdf"]);
    assert_eq!((table.code, table.err.as_str()), (Some(0), ""));
    assert!(table.out.contains("oscillation") && table.out.contains(" 0.69128 "), "{}", table.out);
}

#[test]
fn positions_may_be_a_list_or_have_names_and_torques_find_the_pose() {
    let here = pendulum("linearize_pose");
    let ask = |args: &[&str]| json(&gyroflex(&here, &[&["linearize", "pendulum.urdf"], args].concat()));
    let at = ask(&["--q", "0.5"]);
    assert_eq!(at, ask(&["--q", "hinge=0.5"]));
    close(&at["A"][1][0], -WEIGHT * 0.5_f64.cos() / INERTIA);
    close(&at["B"][1][0], 1.0 / INERTIA);
    close(&at["tau"][0], WEIGHT * 0.5_f64.sin());
    let held = ask(&["--tau", &format!("hinge={}", WEIGHT * 0.5_f64.sin())]);
    close(&held["q"][0], 0.5);
}

#[test]
fn along_a_scenario_there_is_a_model_an_instant() {
    let here = folder("linearize_scenario");
    let (robot, scenario) = (project("robots/puma560/robot.yaml"), project("robots/puma560/track.yaml"));
    let [robot, scenario] = [&robot, &scenario].map(|p| p.to_str().expect("a path in UTF-8"));
    let ended = gyroflex(&here, &["-q", "linearize", robot, "--scenario", scenario, "--at", "0,0.5"]);
    let series = json(&ended);
    assert_eq!((series[0]["time"].as_f64(), series[1]["time"].as_f64()), (Some(0.0), Some(0.5)));
    // One instant is a list too.
    let one = json(&gyroflex(&here, &["-q", "linearize", robot, "--scenario", scenario, "--at", "0.5"]));
    assert_eq!(one[0], series[1]);
}

#[test]
fn a_free_floating_robot_has_no_input_at_its_root_and_says_what_holds_it() {
    let here = pendulum("linearize_floating");
    let urdf = process::PENDULUM.replace(
        r#"<link name="base"/>"#,
        r#"<link name="base"><inertial><mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>"#,
    );
    write(&here, "flying.urdf", &urdf);
    let ended = gyroflex(&here, &["linearize", "flying.urdf", "--floating"]);
    assert!(ended.err.contains("nothing holds a floating root"), "{}", ended.err);
    let model = json(&ended);
    assert_eq!(model["inputs"], serde_json::json!(["tau.hinge"]));
    assert_eq!(model["states"].as_array().map(Vec::len), Some(14));
}

#[test]
fn pictures_are_svg_or_png_as_their_names_say() {
    let here = pendulum("plots");
    for (command, more) in [("modes", &[][..]), ("frf", &["--joint", "hinge"][..])] {
        for kind in ["svg", "png"] {
            let file = format!("{command}.{kind}");
            let ended = gyroflex(&here, &[&[command, "robot.yaml", "--plot", &file], more].concat());
            assert_eq!(ended.code, Some(0), "{}", ended.err);
            assert!(ended.err.contains(&format!("written: {file}")) && ended.out.contains("Hz"), "{}", ended.err);
            let bytes = std::fs::read(here.join(&file)).expect("it was written");
            if kind == "png" {
                assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "{file}");
                continue;
            }
            let text = String::from_utf8(bytes).expect("SVG is text");
            assert!(text.starts_with("<svg width=\"900\"") && text.trim_end().ends_with("</svg>"), "{file}");
            assert!(text.contains("pendulum, complete model"), "{file}");
        }
    }
}

#[test]
fn a_response_is_printed_as_json_and_written_as_csv_with_the_same_numbers() {
    let here = pendulum("frf_files");
    let args = ["frf", "robot.yaml", "--joint", "hinge", "--from", "0.1", "--to", "100", "--points", "50"];
    let printed = json(&gyroflex(&here, &[&args[..], &["--json", "--csv", "hinge.csv"]].concat()));
    let text = std::fs::read_to_string(here.join("hinge.csv")).expect("it was written");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("frequency,motor_magnitude,motor_phase,link_magnitude,link_phase"));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), 50);
    for (i, row) in rows.iter().enumerate() {
        let (motor, link) = (&printed["motor"], &printed["link"]);
        let columns = [&printed["frequency"], &motor["magnitude"], &motor["phase"], &link["magnitude"], &link["phase"]];
        assert_eq!(*row, columns.map(|c| c[i].as_f64().expect("a number")), "line {i}");
    }
    assert_eq!((rows[0][0], rows[49][0]), (0.1, 100.0));
}

#[test]
fn what_cannot_be_is_refused_with_the_option_and_a_remedy() {
    let here = pendulum("linear_refused");
    for (args, words) in [
        (&["linearize", "robot.yaml", "--q", "1,2"][..], &["--q", "hinge"][..]),
        (&["linearize", "robot.yaml", "--q", "one"], &["--q", "`one`"]),
        (&["linearize", "robot.yaml", "--q", "hing=1"], &["--q", "`hinge`"]),
        (&["linearize", "robot.yaml", "--q", "hinge=1,hinge=2"], &["--q", "twice"]),
        (&["linearize", "robot.yaml", "--q", "inf"], &["--q", "inf"]),
        (&["linearize", "robot.yaml", "--tau", "100"], &["--tau", "hinge"]),
        (&["linearize", "robot.yaml", "--output", "motor-positon"], &["--output", "`motor-position`"]),
        (&["linearize", "robot.yaml", "--output", "pose:bib"], &["output", "`bob`"]),
        (&["linearize", "robot.yaml", "--q", "3", "--zoh", "1e9"], &["zero-order hold", "smaller"]),
        (&["linearize", "robot.yaml", "--mat", "robot.yaml"], &["robot.yaml", "overwritten"]),
        (&["linearize", "robot.yaml", "--scenario", "scenario.yaml", "--at", "9"], &["9 s", "0.2"]),
        (&["linearize", "ghost.yaml"], &["ghost.yaml"]),
        (&["modes", "robot.yaml", "--plot", "no/such/folder.svg"], &["no/such/folder.svg"]),
        (&["frf", "robot.yaml", "--joint", "hing"], &["--joint", "`hinge`"]),
        (&["frf", "robot.yaml", "--joint", "hinge", "--from", "2", "--to", "1"], &["2 Hz", "smaller one first"]),
    ] {
        let ended = gyroflex(&here, args);
        assert_eq!((ended.code, ended.out.as_str()), (Some(1), ""), "{args:?}: {}", ended.err);
        assert_eq!(ended.err.matches("error: ").count(), 1, "{args:?}: {}", ended.err);
        for word in ["remedy: "].iter().chain(words) {
            assert!(ended.err.contains(word), "{args:?}: no `{word}` in\n{}", ended.err);
        }
    }
}
