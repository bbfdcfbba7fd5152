//! Links that bend through the binary.

mod process;

use process::{folder, gyroflex, project, with_input, write};
use serde_json::Value;

fn arm() -> String {
    project("robots/book_two_link/robot.yaml").display().to_string()
}

#[test]
fn info_lists_modes_and_counts_them() {
    let here = folder("flexible_info");
    let info: Value = serde_json::from_str(&gyroflex(&here, &["info", &arm(), "--json"]).out).expect("JSON");
    assert_eq!((info["nq"].as_u64(), info["nv"].as_u64()), (Some(6), Some(6)));
    let modes = &info["flexible_links"][0]["modes"];
    assert_eq!(
        (modes[1]["name"].as_str(), modes[1]["boundary"].as_str()),
        (Some("upper.bending_y2"), Some("clamped_free"))
    );
    let text = gyroflex(&here, &["info", &arm()]).out;
    assert!(text.contains("Links that bend") && text.contains("lower.bending_y1"), "{text}");
}

#[test]
fn eval_answers_with_the_modes_accelerations() {
    let line = r#"{"q": [0.3, 0.2], "qd": [0, 0], "tau": [0, 0], "eta": [0.01, 0, 0, 0]}"#;
    let ended = with_input(&folder("flexible_eval"), &["eval", &arm(), "--matrices", "--energy"], &format!("{line}\n"));
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let answer: Value = serde_json::from_str(&ended.out).expect("JSON");
    assert_eq!(answer["qdd"].as_array().map(Vec::len), Some(2));
    assert_eq!(answer["etadd"].as_array().map(Vec::len), Some(4));
    assert_eq!(answer["M"].as_array().map(Vec::len), Some(6));
    let stiffness = answer["K"][0][0].as_f64().expect("a number");
    let stored = 0.5 * stiffness * 0.01 * 0.01;
    assert!((answer["energy"]["elastic"].as_f64().expect("a number") - stored).abs() < 1e-12 * stored);
}

#[test]
fn modes_are_named_and_simulations_and_inverses_run() {
    let here = folder("flexible_run");
    let table = gyroflex(&here, &["modes", &arm()]);
    assert!(table.code == Some(0) && table.out.contains("eta.upper.bending_y1"), "{} {}", table.out, table.err);
    let scenario = format!(
        "robot: {}\nduration: 0.05\nintegrator: {{method: rk4, step: 1.0e-4}}\n\
         reference: {{joint1: {{type: quintic, from: 0, to: 0.2, start: 0, duration: 0.05}}}}\n",
        arm()
    );
    write(&here, "reach.yaml", &scenario);
    let ended = gyroflex(&here, &["simulate", "reach.yaml", "--csv", "run.csv", "--output", "run.mcap"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let header = std::fs::read_to_string(here.join("run.csv")).expect("it is written");
    assert!(
        header.lines().next().is_some_and(|l| l.contains("eta.lower.bending_y2 [m]") && l.contains("tip.upper.y [m]"))
    );
    let ended = gyroflex(&here, &["inverse", "reach.yaml", "--output", "inverse.mcap"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(ended.out.contains("internal dynamics: undamped, of links that bend"), "{}", ended.out);
    assert!(ended.err.contains("give the links damping"), "{}", ended.err);
}

#[test]
fn what_is_refused_names_link_file_and_remedy() {
    let here = folder("flexible_refusals");
    let elastic = project("robots/book_two_link/elastic.yaml").display().to_string();
    write(&here, "elastic.yaml", &format!("robot: {elastic}\nduration: 0.1\n"));
    for arguments in [&["inverse", "elastic.yaml"][..], &["bench", &arm()], &["export", &arm(), "--rust"]] {
        let ended = gyroflex(&here, arguments);
        assert_ne!(ended.code, Some(0));
        let text = &ended.err;
        assert!(text.contains("flexible_links.upper: the link bends, and") && text.contains("remedy: "), "{text}");
    }
}
