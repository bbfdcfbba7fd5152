//! What is written to a log comes back from it.

mod log_common;

use gyroflex_sim::record::{CsvRecorder, McapRecorder, MemoryRecorder, Recorder, TeeRecorder, read_states};
use log_common::{folder, impact, info, sample};
use std::path::Path;
use std::process::Command;

const SAMPLES: usize = 2_000;
/// An impact comes after every so many samples.
const IMPACT_EVERY: usize = 50;

/// Writes the made-up run to memory, MCAP and CSV at once.
fn write(mcap: &Path, csv: &Path) -> MemoryRecorder {
    let mut memory = MemoryRecorder::new(info());
    let mut tee = TeeRecorder::new()
        .with(&mut memory)
        .with(McapRecorder::create(mcap, info()).unwrap())
        .with(CsvRecorder::create(csv, info()).unwrap());
    for k in 0..SAMPLES {
        tee.record(&sample(k)).unwrap();
        if k % IMPACT_EVERY == 0 {
            tee.impact(&impact(k)).unwrap();
        }
    }
    tee.finish().unwrap();
    drop(tee);
    memory
}

#[test]
fn states_read_back_equal_the_record_in_memory() {
    let folder = folder("log_states");
    let memory = write(&folder.join("run.mcap"), &folder.join("run.csv"));
    let log = read_states(&folder.join("run.mcap")).unwrap();
    assert!(log.complete);
    let table = memory.table();
    assert_eq!(table.len(), SAMPLES);
    let without_frames = table.columns.iter().filter(|c| !c.name.starts_with("frame.")).count();
    assert_eq!(log.table.columns, table.columns[..without_frames]);
    assert_eq!(log.table.values, table.values[..without_frames]);
    assert_eq!(log.impacts.len(), SAMPLES / IMPACT_EVERY);
    assert_eq!(log.impacts, memory.impacts());
    assert_eq!(log.impacts[1], impact(IMPACT_EVERY));
    assert_eq!(table.get("theta.Ellbogen_ä").unwrap()[7], sample(7).theta[1]);
    assert_eq!(table.columns.iter().find(|c| c.name == "tau.slide").unwrap().unit, "N");
}

#[test]
fn csv_read_back_equals_the_record_in_memory() {
    let folder = folder("log_csv");
    let table = write(&folder.join("run.mcap"), &folder.join("run.csv")).table();
    let mut reader = csv::Reader::from_path(folder.join("run.csv")).unwrap();
    let header: Vec<String> = table.columns.iter().map(|c| format!("{} [{}]", c.name, c.unit)).collect();
    assert_eq!(reader.headers().unwrap().iter().collect::<Vec<_>>(), header);
    let mut rows = 0;
    for (k, row) in reader.records().enumerate() {
        for (column, text) in table.values.iter().zip(&row.unwrap()) {
            assert_eq!(text.parse::<f64>().unwrap(), column[k]);
        }
        rows += 1;
    }
    assert_eq!(rows, SAMPLES);
}

#[test]
fn log_has_an_index_its_files_and_its_parameters() {
    let folder = folder("log_index");
    write(&folder.join("run.mcap"), &folder.join("run.csv"));
    let bytes = std::fs::read(folder.join("run.mcap")).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().expect("a finished log has a summary");
    let stats = summary.stats.as_ref().unwrap();
    assert_eq!(stats.message_count as usize, 4 * SAMPLES + SAMPLES / IMPACT_EVERY + 1);
    assert_eq!(stats.message_end_time, (SAMPLES as u64 - 1) * 1_000_000);
    assert!(summary.chunk_indexes.len() > 2);
    assert!(summary.chunk_indexes.iter().all(|c| c.compression == "zstd" && c.uncompressed_size < 1_100_000));
    for (index, (name, content)) in summary.attachment_indexes.iter().zip(info().attachments) {
        let attachment = mcap::read::attachment(&bytes, index).unwrap();
        assert_eq!((attachment.name, attachment.data.into_owned()), (name, content.into_bytes()));
    }
    assert_eq!(summary.attachment_indexes.len(), info().attachments.len());
    let metadata = mcap::read::metadata(&bytes, &summary.metadata_indexes[0]).unwrap();
    assert!(info().metadata.iter().all(|(key, value)| metadata.metadata.get(key) == Some(value)));
    let mut topics: Vec<_> = summary.channels.values().map(|c| c.topic.clone()).collect();
    topics.sort();
    let all = ["/gyroflex/impacts", "/gyroflex/state", "/joint_states", "/motor_states", "/robot_description", "/tf"];
    assert_eq!(topics, all);
}

#[test]
fn times_of_messages_are_simulated_time_and_never_decrease() {
    let folder = folder("log_times");
    write(&folder.join("run.mcap"), &folder.join("run.csv"));
    let bytes = std::fs::read(folder.join("run.mcap")).unwrap();
    let messages: Vec<_> = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
    assert!(messages.iter().all(|m| m.log_time == m.publish_time));
    assert!(messages.windows(2).all(|m| m[0].log_time <= m[1].log_time));
    let tf: Vec<_> = messages.iter().filter(|m| m.channel.topic == "/tf").map(|m| m.log_time).collect();
    assert!(tf.iter().enumerate().all(|(k, &t)| t == k as u64 * 1_000_000));
}

#[test]
fn log_of_a_robot_without_drives_has_no_motors() {
    let path = folder("log_no_drives").join("run.mcap");
    let mut info = info();
    info.gear_ratios.fill(None);
    let mut recorder = McapRecorder::create(&path, info).unwrap();
    recorder.record(&sample(0)).unwrap();
    recorder.finish().unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert!(summary.channels.values().all(|c| c.topic != "/motor_states"));
}

#[test]
fn log_of_a_robot_without_contacts_has_no_impacts() {
    let path = folder("log_no_contacts").join("run.mcap");
    let (mut info, mut sample) = (info(), sample(0));
    (info.held, info.contacts, sample.footing) = (false, Vec::new(), None);
    let mut recorder = McapRecorder::create(&path, info).unwrap();
    recorder.record(&sample).unwrap();
    assert!(recorder.impact(&impact(0)).is_err(), "the run has no such point");
    recorder.finish().unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert!(summary.channels.values().all(|c| c.topic != "/gyroflex/impacts"));
    assert!(read_states(&path).unwrap().impacts.is_empty());
}

/// The libraries users read logs with decode every message to the numbers of the CSV. Runs where `GYROFLEX_MCAP_PYTHON` names
/// a Python that has `mcap`, `mcap-ros2-support` and `mcap-protobuf-support`.
#[test]
fn python_libraries_decode_the_log_to_the_numbers_of_the_csv() {
    let folder = folder("log_python");
    let (mcap, csv) = (folder.join("run.mcap"), folder.join("run.csv"));
    write(&mcap, &csv);
    let Some(python) = std::env::var_os("GYROFLEX_MCAP_PYTHON") else {
        println!("skipped: GYROFLEX_MCAP_PYTHON names no Python with the MCAP libraries");
        return;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/check_log.py");
    let ratios: Vec<String> = info().gear_ratios.iter().map(|r| r.map_or("-".to_owned(), |r| r.to_string())).collect();
    let output = Command::new(python).arg(script).args([&mcap, &csv]).args(ratios).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    println!("{said}");
}
