//! What cannot be recorded or read is an error with file, element and remedy.

mod log_common;

use gyroflex_sim::record::{CsvRecorder, McapRecorder, MemoryRecorder, Recorder, RunInfo, Sample, read_states};
use gyroflex_sim::{Error, ErrorKind};
use log_common::{folder, info, sample};
use std::path::Path;

#[track_caller]
fn names_all(e: &Error, file: &Path) {
    assert_eq!((e.kind, e.file.as_str()), (ErrorKind::Io, file.to_str().unwrap()));
    assert!(!e.problem.is_empty() && !e.remedy.is_empty());
}

#[test]
fn file_that_cannot_be_written_is_named() {
    let folder = folder("log_refuses");
    for path in [folder.join("missing/run.mcap"), folder.clone()] {
        names_all(&McapRecorder::create(&path, info()).err().unwrap(), &path);
        names_all(&CsvRecorder::create(&path, info()).err().unwrap(), &path);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn disk_that_is_full_from_the_start_is_named() {
    let path = Path::new("/dev/full");
    names_all(&McapRecorder::create(path, info()).err().unwrap(), path);
    names_all(&CsvRecorder::create(path, info()).err().unwrap(), path);
}

#[test]
fn file_that_is_no_log_is_named() {
    let folder = folder("log_no_log");
    let text = folder.join("text.mcap");
    std::fs::write(&text, "time,q\n0,1\n".repeat(100)).unwrap();
    for path in [text, folder.join("missing.mcap"), folder] {
        names_all(&read_states(&path).unwrap_err(), &path);
    }
}

#[test]
fn flipped_bit_in_a_chunk_is_found() {
    let path = folder("log_flipped").join("run.mcap");
    let mut recorder = McapRecorder::create(&path, info()).unwrap();
    (0..50).for_each(|k| recorder.record(&sample(k)).unwrap());
    recorder.finish().unwrap();
    let mut bytes = std::fs::read(&path).unwrap();
    let chunk = mcap::Summary::read(&bytes).unwrap().unwrap().chunk_indexes[1].clone();
    bytes[(chunk.chunk_start_offset + chunk.chunk_length / 2) as usize] ^= 1;
    std::fs::write(&path, bytes).unwrap();
    names_all(&read_states(&path).unwrap_err(), &path);
}

/// Every recorder refuses the sample, and takes a good one after it.
#[track_caller]
fn refused(kind: ErrorKind, element: &str, spoil: impl Fn(&mut Sample)) {
    let disks = [Vec::new(), Vec::new()];
    let [mcap, csv] = disks;
    let recorders: [Box<dyn Recorder>; 3] = [
        Box::new(MemoryRecorder::new(info())),
        Box::new(McapRecorder::new(mcap, "memory", info(), Default::default()).unwrap()),
        Box::new(CsvRecorder::new(csv, "memory", info()).unwrap()),
    ];
    for mut recorder in recorders {
        recorder.record(&sample(5)).unwrap();
        let mut bad = sample(6);
        spoil(&mut bad);
        let e = recorder.record(&bad).unwrap_err();
        assert_eq!(e.kind, kind);
        assert!(e.element.contains(element), "`{element}` is not in `{}`", e.element);
        assert!(!e.remedy.is_empty());
        recorder.record(&sample(7)).unwrap();
        recorder.finish().unwrap();
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused_by_name() {
    refused(ErrorKind::Diverged, "qd of joint `slide`", |s| s.qd[2] = f64::NAN);
    refused(ErrorKind::Diverged, "tau_j of joint `shoulder`", |s| s.tau_j[0] = f64::INFINITY);
    refused(ErrorKind::Diverged, "power_in", |s| s.power_in = f64::NAN);
    refused(ErrorKind::Diverged, "link `tool`", |s| s.frames[2].pos.y = f64::NAN);
    refused(ErrorKind::Diverged, "floating root", |s| s.base_pose = Some([f64::NAN; 7]));
}

#[test]
fn samples_of_another_run_are_refused_by_name() {
    refused(ErrorKind::Shape, "theta", |s| s.theta.truncate(1));
    refused(ErrorKind::Shape, "frames", |s| s.frames.clear());
    refused(ErrorKind::Shape, "base", |s| s.base_twist = None);
}

#[test]
fn time_that_runs_back_or_is_no_time_is_refused() {
    for t in [0.004, -1.0, f64::NAN, f64::INFINITY, 1e10] {
        refused(ErrorKind::Shape, "time", |s| s.t = t);
    }
}

#[test]
fn finished_recorder_takes_no_more_samples() {
    let mut recorder = McapRecorder::new(Vec::new(), "memory", RunInfo::default(), Default::default()).unwrap();
    let empty = Sample::default();
    recorder.record(&empty).unwrap();
    recorder.finish().unwrap();
    assert!(recorder.record(&empty).is_err());
    recorder.finish().unwrap();
}
