//! Laws of pipes: answers stream, and a reader who leaves is no error.

mod process;

use process::{end, gyroflex, pendulum, start, with_input, write};
use std::io::{BufRead, BufReader, Write};

const LINE: &str = "{\"q\": [0.3], \"qd\": [0], \"theta\": [0.3], \"thetad\": [0], \"tau\": [0]}\n";

#[test]
fn every_line_is_answered_before_the_next_one_is_read() {
    let here = pendulum("stream");
    let mut child = start(&here, &["eval", "robot.yaml", "--state", "-"]);
    let mut stdin = child.stdin.take().expect("piped");
    let mut answers = BufReader::new(child.stdout.take().expect("piped"));
    for _ in 0..3 {
        stdin.write_all(LINE.as_bytes()).expect("the calculator reads");
        let mut answer = String::new();
        answers.read_line(&mut answer).expect("the calculator answers");
        assert!(answer.contains("\"qdd\":["), "{answer}");
    }
    drop(stdin);
    assert_eq!(end(child).code, Some(0));
}

#[test]
fn a_reader_who_leaves_early_is_no_error() {
    let here = pendulum("head");
    write(&here, "states.jsonl", &LINE.repeat(20_000));
    let mut child = start(&here, &["eval", "robot.yaml", "--state", "states.jsonl"]);
    let mut answers = BufReader::new(child.stdout.take().expect("piped"));
    answers.read_line(&mut String::new()).expect("a first answer");
    drop(answers);
    let ended = end(child);
    assert_eq!((ended.code, ended.err.as_str()), (Some(0), ""));

    for args in [
        &["info", "robot.yaml"][..],
        &["schema", "robot"],
        &["completions", "bash"],
        &["simulate", "scenario.yaml", "-q"],
    ] {
        let mut child = start(&here, args);
        drop(child.stdout.take());
        let ended = end(child);
        assert_eq!((ended.code, ended.err.as_str()), (Some(0), ""), "{args:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let here = pendulum("full");
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("linux has /dev/full");
    let status = std::process::Command::new(env!("CARGO_BIN_EXE_gyroflex"))
        .args(["info", "robot.yaml"])
        .current_dir(&here)
        .stdout(full)
        .output()
        .expect("the binary starts");
    let message = String::from_utf8_lossy(&status.stderr).into_owned();
    assert!(status.status.code() == Some(1) && message.contains("standard output"), "{message}");
}

#[test]
fn a_wrong_line_ends_with_1_after_the_answers_before_it_and_is_named() {
    let here = pendulum("wrong_line");
    let input = format!("{LINE}\n{LINE}{{\"q\": [1, 2]}}\n{LINE}");
    for (args, name) in [
        (&["eval", "robot.yaml"][..], "standard input:4"),
        (&["eval", "robot.yaml", "--state", "states.jsonl"], "states.jsonl:4"),
    ] {
        write(&here, "states.jsonl", &input);
        let ended = with_input(&here, args, &input);
        assert_eq!(ended.code, Some(1));
        assert_eq!(ended.out.lines().count(), 2);
        assert!(
            ended.err.contains(name) && ended.err.contains(": q: ") || ended.err.contains("tau, qdd"),
            "{}",
            ended.err
        );
        assert!(ended.err.contains("remedy:"), "{}", ended.err);
    }
}

#[test]
fn input_that_is_no_text_is_refused_with_its_line() {
    let here = pendulum("binary");
    std::fs::write(here.join("states.jsonl"), [LINE.as_bytes(), b"\xff\xfe\n"].concat()).expect("written");
    let ended = gyroflex(&here, &["eval", "robot.yaml", "--state", "states.jsonl"]);
    assert!(
        ended.code == Some(1) && ended.err.contains("states.jsonl:2") && ended.out.lines().count() == 1,
        "{}",
        ended.err
    );
    for bad in [".", "/dev/null/x"] {
        assert_eq!(gyroflex(&here, &["eval", "robot.yaml", "--state", bad]).code, Some(1));
    }
}
