//! A log outlives what happens to its run: an early drop, a kill, a full disk.

mod log_common;

use gyroflex_sim::ErrorKind;
use gyroflex_sim::record::{ChunkLimits, CsvRecorder, McapRecorder, Recorder, TeeRecorder, read_states};
use log_common::{folder, info, sample};
use std::cell::RefCell;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::rc::Rc;
use std::time::{Duration, Instant};

const SMALL: ChunkLimits = ChunkLimits { bytes: 2_500, age: Duration::from_secs(3600) };

/// A disk of limited size that others can look at.
#[derive(Clone)]
struct Disk {
    bytes: Rc<RefCell<Vec<u8>>>,
    size: usize,
}

impl Disk {
    fn new(size: usize) -> Self {
        Self { bytes: Rc::default(), size }
    }
}

impl Write for Disk {
    fn write(&mut self, data: &[u8]) -> io::Result<usize> {
        let mut bytes = self.bytes.borrow_mut();
        let fits = data.len().min(self.size - bytes.len());
        if fits == 0 && !data.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        bytes.extend_from_slice(&data[..fits]);
        Ok(fits)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn written(bytes: &[u8], path: &Path) -> gyroflex_sim::record::StateLog {
    std::fs::write(path, bytes).unwrap();
    read_states(path).unwrap()
}

/// Counts the samples on disk once the recorder has closed a chunk: `(size of the file, samples in it)`.
fn chunk_ends(limits: ChunkLimits, samples: usize) -> (Vec<u8>, Vec<(usize, usize)>) {
    let disk = Disk::new(usize::MAX);
    let mut recorder = McapRecorder::new(disk.clone(), "disk", info(), limits).unwrap();
    let mut ends = vec![(disk.bytes.borrow().len(), 0)];
    for k in 0..samples {
        recorder.record(&sample(k)).unwrap();
        let size = disk.bytes.borrow().len();
        if size > ends[ends.len() - 1].0 {
            ends.push((size, k + 1));
        }
    }
    recorder.finish().unwrap();
    (disk.bytes.take(), ends)
}

#[test]
fn log_cut_at_any_byte_loses_at_most_the_chunk_that_was_cut() {
    let (bytes, ends) = chunk_ends(ChunkLimits { bytes: 1, ..SMALL }, 4);
    assert!(ends.len() == 5, "a chunk a sample");
    let path = folder("log_cut").join("cut.mcap");
    // Every byte where samples are; what comes before and after them is long and all alike.
    let samples = ends[0].0..=ends[4].0;
    for cut in (0..bytes.len()).filter(|cut| samples.contains(cut) || cut % 11 == 0) {
        let safe = ends.iter().rev().find(|(size, _)| *size <= cut).map_or(0, |(_, samples)| *samples);
        let log = written(&bytes[..cut], &path);
        assert!(!log.complete);
        assert!(log.table.len() >= safe, "{} samples of {safe} at byte {cut}", log.table.len());
        for (k, &t) in log.table.get("time").unwrap_or_default().iter().enumerate() {
            assert_eq!(t, sample(k).t);
        }
    }
    assert!(written(&bytes, &path).complete);
}

#[test]
fn samples_are_never_torn_between_chunks() {
    let (bytes, _) = chunk_ends(SMALL, 41);
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let messages = |index| summary.stream_chunk(&bytes, index).unwrap().map(Result::unwrap).count();
    let counts: Vec<_> = summary.chunk_indexes.iter().map(messages).collect();
    assert_eq!(counts[0], 1, "the robot description has a chunk of its own");
    assert!(counts[1..].iter().all(|n| n % 4 == 0), "all four messages of each sample");
    assert_eq!(counts.iter().sum::<usize>(), 4 * 41 + 1);
}

#[test]
fn dropped_recorder_leaves_a_finished_log() {
    let path = folder("log_drop").join("run.mcap");
    let mut recorder = McapRecorder::create(&path, info()).unwrap();
    for k in 0..10 {
        recorder.record(&sample(k)).unwrap();
    }
    drop(recorder);
    let log = read_states(&path).unwrap();
    assert!(log.complete);
    assert_eq!(log.table.len(), 10);
    let bytes = std::fs::read(&path).unwrap();
    assert!(!mcap::Summary::read(&bytes).unwrap().unwrap().chunk_indexes.is_empty());
}

#[test]
fn chunks_are_closed_by_time_as_well_as_by_size() {
    let disk = Disk::new(usize::MAX);
    let limits = ChunkLimits { bytes: usize::MAX, age: Duration::from_millis(20) };
    let mut recorder = McapRecorder::new(disk.clone(), "disk", info(), limits).unwrap();
    let start = disk.bytes.borrow().len();
    recorder.record(&sample(0)).unwrap();
    std::thread::sleep(Duration::from_millis(30));
    recorder.record(&sample(1)).unwrap();
    assert!(disk.bytes.borrow().len() > start);
}

/// Not a law but the process that the next test kills: it records until then.
#[test]
fn writer_to_be_killed() {
    let Some(path) = std::env::var_os("GYROFLEX_TEST_LOG") else { return };
    let mut recorder = McapRecorder::new(std::fs::File::create(path).unwrap(), "log", info(), SMALL).unwrap();
    for k in 0.. {
        recorder.record(&sample(k)).unwrap();
        std::thread::sleep(Duration::from_micros(100));
    }
}

#[test]
fn killed_run_leaves_all_its_closed_chunks() {
    let path = folder("log_kill").join("run.mcap");
    let _ = std::fs::remove_file(&path);
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "writer_to_be_killed"])
        .env("GYROFLEX_TEST_LOG", &path)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let deadline = Instant::now() + Duration::from_secs(60);
    while std::fs::metadata(&path).map_or(0, |m| m.len()) < 60_000 && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let log = read_states(&path).unwrap();
    assert!(!log.complete);
    let (bytes, ends) = chunk_ends(SMALL, log.table.len() + 20);
    // The same run, never killed, has the same chunks: what the kill left is a prefix of it.
    let left = std::fs::read(&path).unwrap();
    assert!(bytes.starts_with(&left));
    let (_, safe) = ends.iter().rev().find(|(size, _)| *size <= left.len()).unwrap();
    assert!(log.table.len() >= *safe && *safe > 0, "{} samples of {safe}", log.table.len());
}

#[test]
fn full_disk_is_an_error_that_names_the_log_and_keeps_what_was_written() {
    let disk = Disk::new(40_000);
    let mut recorder = McapRecorder::new(disk.clone(), "out/run.mcap", info(), SMALL).unwrap();
    let (failed, e) = (0..).find_map(|k| recorder.record(&sample(k)).err().map(|e| (k, e))).unwrap();
    assert_eq!((e.kind, e.file.as_str()), (ErrorKind::Io, "out/run.mcap"));
    assert!(!e.remedy.is_empty());
    assert!(recorder.finish().is_err());
    let log = written(&disk.bytes.take(), &folder("log_full").join("cut.mcap"));
    let a_chunk = chunk_ends(SMALL, 40).1[1].1;
    assert!(log.table.len() + a_chunk > failed, "{} of {failed} samples", log.table.len());
}

#[test]
fn failed_recorder_does_not_cost_the_others_their_samples() {
    let folder = folder("log_tee");
    let full = McapRecorder::new(Disk::new(8_000), "full", info(), SMALL).unwrap();
    let mut tee = TeeRecorder::new().with(full).with(CsvRecorder::create(&folder.join("run.csv"), info()).unwrap());
    let failed = (0..100).filter(|&k| tee.record(&sample(k)).is_err()).count();
    assert!(failed > 0);
    assert!(tee.finish().is_err());
    let text = std::fs::read_to_string(folder.join("run.csv")).unwrap();
    assert_eq!(text.lines().count(), 101);
}
