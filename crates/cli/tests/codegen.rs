//! Equations written as code and as documents.

mod process;

use process::{ROBOT, gyroflex, pendulum, project, write};

#[test]
fn every_language_has_its_files() {
    let here = pendulum("codegen");
    for (language, files) in [
        ("rust", &["pendulum.rs"][..]),
        ("c", &["pendulum.h", "pendulum.c", "pendulum_test.c"]),
        ("python", &["pendulum.py"]),
        ("json", &["pendulum.json"]),
        ("latex", &["pendulum.tex"]),
    ] {
        let ended = gyroflex(&here, &["codegen", "robot.yaml", "--lang", language, "-o", language]);
        assert_eq!(ended.code, Some(0), "{language}: {}", ended.err);
        for file in files {
            let text = std::fs::read_to_string(here.join(language).join(file)).expect("the file was written");
            assert!(text.contains("gyroflex codegen robot.yaml --model complete"), "{file} says how it is made again");
            assert!(ended.err.contains(file), "{}", ended.err);
        }
        let count = std::fs::read_dir(here.join(language)).expect("the folder was made").count();
        assert_eq!(count, files.len(), "{language}");
    }
}

/// Made again by the command that its first lines name, a file is the same.
#[test]
fn files_name_the_command_that_makes_them_again() {
    let here = pendulum("codegen_again");
    let set = "drives.hinge.transmission.stiffness=123";
    let first = gyroflex(&here, &["codegen", "robot.yaml", "--lang", "python", "--set", set, "-o", "one"]);
    assert_eq!(first.code, Some(0), "{}", first.err);
    let read = |folder: &str| std::fs::read_to_string(here.join(folder).join("pendulum.py")).expect("it was written");
    let text = read("one");
    let line = text.lines().find_map(|line| line.trim().strip_prefix("gyroflex ")).expect("it names a command");
    let again: Vec<&str> = line.split(' ').map(|word| word.trim_matches('\'')).chain(["-o", "two"]).collect();
    let second = gyroflex(&here, &again);
    assert_eq!(second.code, Some(0), "{}", second.err);
    assert_eq!(read("two"), text);
    assert!(gyroflex(&here, &["codegen", "robot.yaml", "--lang", "python", "-o", "three"]).code == Some(0));
    assert_ne!(read("three"), text);
}

#[test]
fn report_says_what_functions_take_give_and_cost() {
    let here = pendulum("codegen_report");
    let args = ["codegen", "robot.yaml", "--what", "all", "--keep-symbol", "bob.mass", "--json"];
    let ended = gyroflex(&here, &args);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let report: serde_json::Value = serde_json::from_str(&ended.out).expect("it is JSON");
    let functions = report["functions"].as_array().expect("a list");
    let forward = &functions[0];
    assert_eq!(forward["name"], "forward_dynamics");
    let names: Vec<&str> =
        forward["arguments"].as_array().expect("a list").iter().filter_map(|a| a[0].as_str()).collect();
    assert_eq!(names, ["q", "qd", "theta", "thetad", "tau", "parameters"]);
    let count = |key: &str| forward[key].as_u64().expect("a number");
    let sum = ["additions", "multiplications", "divisions", "circular", "others"].map(count).iter().sum::<u64>();
    assert!(count("operations") == sum && sum > 0);
    assert!(functions.len() > 10, "{} quantities", functions.len());
}

/// Along a scenario: fewer terms at larger tolerances, none lost at none.
#[test]
fn terms_are_weighed_along_a_scenario() {
    let here = process::folder("codegen_weighed");
    let robot = project("robots/puma560/robot.yaml").display().to_string();
    let along = project("robots/puma560/track.yaml").display().to_string();
    let args = ["codegen", &robot, "--simplify-to", "1e-2", "--along", &along, "--json"];
    let ended = gyroflex(&here, &args);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let report: serde_json::Value = serde_json::from_str(&ended.out).expect("it is JSON");
    let rows = report["weighing"].as_array().expect("a table");
    let column = |key: &str| -> Vec<f64> { rows.iter().filter_map(|row| row[key].as_f64()).collect() };
    assert!(column("tolerance").is_sorted_by(|a, b| a > b));
    assert!(column("kept").is_sorted());
    let errors = column("torque_error");
    assert!(errors.iter().zip(column("tolerance")).all(|(error, tolerance)| *error <= 10.0 * tolerance), "{errors:?}");
    assert_eq!(errors.last(), Some(&0.0));
}

#[test]
fn what_cannot_be_generated_is_refused_by_element_and_remedy() {
    let here = pendulum("codegen_refused");
    write(&here, "taken", "a file");
    for (case, args, words) in [
        ("no robot", &["nobody.yaml"][..], &["nobody.yaml"][..]),
        ("unknown quantity", &["robot.yaml", "--what", "forwards"], &["--what", "`forwards`", "forward, inverse"]),
        ("unknown parameter", &["robot.yaml", "--keep-symbol", "nobody.mass"], &["--keep-symbol", "nobody"]),
        ("unknown link", &["robot.yaml", "--what", "jacobian", "--link", "nobody"], &["--link", "nobody", "bob"]),
        ("no part", &["robot.yaml", "--split", "0"], &["--split", "at least 1"]),
        ("parts in C", &["robot.yaml", "--split", "2", "--lang", "c"], &["--split", "--lang rust"]),
        ("lanes in C", &["robot.yaml", "--lanes", "4", "--lang", "c"], &["--lanes", "--lang rust"]),
        ("outside the folder", &["robot.yaml", "--name", "../evil"], &["--name", "letters, digits"]),
        ("no tolerance", &["robot.yaml", "--simplify-to", "NaN"], &["--simplify-to", "1e-3"]),
        ("a file for a folder", &["robot.yaml", "-o", "taken"], &["taken", "cannot be written"]),
        ("no scenario", &["robot.yaml", "--simplify-to", "0", "--along", "no.yaml"], &["no.yaml"]),
    ] {
        let ended = gyroflex(&here, &[&["codegen"], args].concat());
        assert_eq!((ended.code, ended.out.as_str()), (Some(1), ""), "{case}: {}", ended.err);
        for word in ["error: ", "remedy: "].iter().chain(words) {
            assert!(ended.err.contains(word), "{case}: no `{word}` in\n{}", ended.err);
        }
    }
    let robot = std::fs::read_to_string(here.join("robot.yaml")).expect("the robot is still there");
    assert_eq!(robot, ROBOT);
}
