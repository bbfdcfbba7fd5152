//! The record as an MCAP log, the format of today's robot viewers.
//!
//! | topic | encoding | schema | content |
//! |---|---|---|---|
//! | `/tf` | protobuf | `foxglove.FrameTransforms` | pose of every link in its parent link, root frame `world` |
//! | `/joint_states` | cdr | `sensor_msgs/msg/JointState` | `q`, `qd` and transmission torque, link side |
//! | `/motor_states` | cdr | `sensor_msgs/msg/JointState` | `N θ`, `N θ̇`, `τ/N`: the motor's own numbers; joints with a drive |
//! | `/robot_description` | cdr | `std_msgs/msg/String` | the URDF, once |
//! | `/gyroflex/state` | protobuf | `gyroflex.State` | all else; units are comments of the schema in the log |
//! | `/gyroflex/impacts` | protobuf | `gyroflex.Impact` | every impact with the ground when it happens; robots with contacts |
//!
//! The robot's and the scenario's files are attachments, the parameters of the run a metadata record named `gyroflex`.
//! Log and publish time are simulated time [ns].
//!
//! The log grows at its final path. Chunks are compressed in memory and appended whole, so at any moment the file is a
//! valid prefix of a log: what a killed process loses is the open chunk, bounded by [`ChunkLimits`]. Attachments,
//! metadata, schemas and description go first and are on their way to the disk before the first sample. Finishing, or
//! dropping the recorder, closes the open chunk and writes the index.

use super::proto::{self, Described, FrameTransform, FrameTransforms, Quaternion, State, Timestamp, Vector3};
use super::quaternion::quaternion;
use super::ros::{self, JointRow, Stamp};
use super::{Impact, Recorder, RunInfo, Sample, file};
use crate::error::Error;
use ::mcap::records::{MessageHeader, Metadata};
use ::mcap::write::NoSeek;
use ::mcap::{Attachment, Compression, McapError, WriteOptions, Writer};
use prost::Message;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// When a chunk is closed and handed to the operating system: as soon as either limit is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChunkLimits {
    /// Size of its messages before compression [bytes].
    pub bytes: usize,
    /// Time on the clock of the machine since it was opened, looked at when a sample comes: the most work a killed
    /// process can lose.
    pub age: Duration,
}

impl Default for ChunkLimits {
    /// 1 MiB, the default of the format's own tools, or one second.
    fn default() -> Self {
        Self { bytes: 1024 * 1024, age: Duration::from_secs(1) }
    }
}

/// Opcode, length, channel, sequence and two times before the data of a message [bytes].
const RECORD_HEADER: usize = 31;

/// Writes samples to an MCAP log.
pub struct McapRecorder<W: Write = File> {
    name: String,
    info: RunInfo,
    limits: ChunkLimits,
    writer: Option<Writer<NoSeek<BufWriter<W>>>>,
    channels: Channels,
    sequence: u32,
    last: Option<f64>,
    chunk_bytes: usize,
    chunk_opened: Instant,
}

/// Channel numbers in the log.
#[derive(Default)]
struct Channels {
    tf: u16,
    joint_states: u16,
    /// Absent where no joint has a drive.
    motor_states: Option<u16>,
    description: u16,
    state: u16,
    /// Absent where no point may touch the ground.
    impacts: Option<u16>,
}

impl McapRecorder {
    /// Creates the log, or empties it, and writes all that is known before the first sample.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(path: &Path, info: RunInfo) -> Result<Self, Error> {
        Self::new(file::create(path)?, &path.display().to_string(), info, ChunkLimits::default())
    }
}

impl<W: Write> McapRecorder<W> {
    /// Starts a log on `sink`, called `name` in errors.
    ///
    /// # Errors
    /// When the sink cannot be written.
    pub fn new(sink: W, name: &str, info: RunInfo, limits: ChunkLimits) -> Result<Self, Error> {
        let mut recorder = Self {
            name: name.to_owned(),
            info,
            limits,
            writer: None,
            channels: Channels::default(),
            sequence: 0,
            last: None,
            chunk_bytes: 0,
            chunk_opened: Instant::now(),
        };
        recorder.open(sink).map_err(|e| error(name, e))?;
        Ok(recorder)
    }

    fn open(&mut self, sink: W) -> Result<(), McapError> {
        let mut writer = WriteOptions::new()
            .library(concat!("gyroflex-sim ", env!("CARGO_PKG_VERSION")))
            .compression(Some(Compression::Zstd))
            .compression_threads(0)
            // Without seeking a chunk reaches the file in one piece, never as a header still to be filled in. Its end is
            // ours to decide, so that no sample is torn between two chunks.
            .disable_seeking(true)
            .chunk_size(None)
            .create(NoSeek::new(BufWriter::new(sink)))?;
        for (name, content) in &self.info.attachments {
            writer.attach(&Attachment {
                log_time: 0,
                create_time: 0,
                name: name.clone(),
                media_type: media_type(name).to_owned(),
                data: Cow::Borrowed(content.as_bytes()),
            })?;
        }
        let metadata = self.info.metadata.iter().cloned().collect();
        writer.write_metadata(&Metadata { name: "gyroflex".to_owned(), metadata })?;
        self.channels = Channels::add(&mut writer, &self.info)?;
        self.writer = Some(writer);
        self.put(self.channels.description, 0, &ros::string(&self.info.urdf))?;
        self.close_chunk()
    }

    fn put(&mut self, channel_id: u16, time: u64, data: &[u8]) -> Result<(), McapError> {
        let writer = self.writer.as_mut().ok_or(McapError::AttemptedWriteAfterFailure)?;
        if self.chunk_bytes == 0 {
            self.chunk_opened = Instant::now();
        }
        let header = MessageHeader { channel_id, sequence: self.sequence, log_time: time, publish_time: time };
        self.chunk_bytes += RECORD_HEADER + data.len();
        writer.write_to_known_channel(&header, data)
    }

    /// Closes the open chunk and hands it to the operating system.
    fn close_chunk(&mut self) -> Result<(), McapError> {
        self.chunk_bytes = 0;
        self.writer.as_mut().map_or(Ok(()), Writer::flush)
    }

    fn put_sample(&mut self, sample: &Sample) -> Result<(), McapError> {
        let stamp = Stamp::new(sample.t);
        let time = stamp.total_nanos();
        let tf = self.transforms(stamp, sample).encode_to_vec();
        self.put(self.channels.tf, time, &tf)?;
        let joints = ros::joint_state(stamp, &self.link_side(sample));
        self.put(self.channels.joint_states, time, &joints)?;
        if let Some(channel) = self.channels.motor_states {
            let motors = ros::joint_state(stamp, &self.motor_side(sample));
            self.put(channel, time, &motors)?;
        }
        let state = State::new(&self.info, sample).encode_to_vec();
        self.put(self.channels.state, time, &state)?;
        self.sequence = self.sequence.wrapping_add(1);
        if self.chunk_bytes >= self.limits.bytes || self.chunk_opened.elapsed() >= self.limits.age {
            self.close_chunk()?;
        }
        Ok(())
    }

    fn transforms(&self, stamp: Stamp, sample: &Sample) -> FrameTransforms {
        let poses = self.info.frames.iter().zip(&sample.frames);
        let transforms = poses.map(|((link, parent), pose)| {
            let [x, y, z, w] = quaternion(pose.rotation());
            FrameTransform {
                timestamp: Some(Timestamp { seconds: i64::from(stamp.seconds), nanos: stamp.nanos.cast_signed() }),
                parent_frame_id: parent.clone(),
                child_frame_id: link.clone(),
                translation: Some(Vector3 { x: pose.pos.x, y: pose.pos.y, z: pose.pos.z }),
                rotation: Some(Quaternion { x, y, z, w }),
            }
        });
        FrameTransforms { transforms: transforms.collect() }
    }

    fn link_side(&self, s: &Sample) -> Vec<JointRow<'_>> {
        let joint = |(i, name)| JointRow { name, position: s.q[i], velocity: s.qd[i], effort: s.tau_j[i] };
        self.info.joints.iter().map(String::as_str).enumerate().map(joint).collect()
    }

    fn motor_side(&self, s: &Sample) -> Vec<JointRow<'_>> {
        let joints = self.info.joints.iter().zip(&self.info.gear_ratios).enumerate();
        let driven = joints.filter_map(|(i, (name, ratio))| ratio.map(|n| (i, name.as_str(), n)));
        let motor = |(i, name, n): (usize, _, f64)| JointRow {
            name,
            position: n * s.theta[i],
            velocity: n * s.thetad[i],
            effort: s.tau[i] / n,
        };
        driven.map(motor).collect()
    }
}

impl<W: Write> Recorder for McapRecorder<W> {
    fn record(&mut self, sample: &Sample) -> Result<(), Error> {
        if self.writer.is_none() {
            return Err(file::finished(&self.name));
        }
        sample.check(&self.info, self.last)?;
        self.put_sample(sample).map_err(|e| error(&self.name, e))?;
        self.last = Some(sample.t);
        Ok(())
    }

    fn impact(&mut self, impact: &Impact) -> Result<(), Error> {
        if self.writer.is_none() {
            return Err(file::finished(&self.name));
        }
        impact.check(&self.info, self.last)?;
        let Some(channel) = self.channels.impacts else { return Ok(()) };
        let message = proto::Impact::new(&self.info, impact).encode_to_vec();
        let time = Stamp::new(impact.t).total_nanos();
        // Its time is found by halving steps, and may be past that of the next sample by rounding: `last` is not for it.
        self.put(channel, time, &message).map_err(|e| error(&self.name, e))
    }

    fn finish(&mut self) -> Result<(), Error> {
        // The writer's own drop finishes a log too, but cannot report what went wrong.
        match self.writer.take() {
            Some(mut writer) => writer.finish().map(drop).map_err(|e| error(&self.name, e)),
            None => Ok(()),
        }
    }
}

impl Channels {
    fn add<W: Write + io::Seek>(writer: &mut Writer<W>, info: &RunInfo) -> Result<Self, McapError> {
        let (motors, contacts) = (info.gear_ratios.iter().any(Option::is_some), !info.contacts.is_empty());
        let none = BTreeMap::new();
        let tf = writer.add_schema("foxglove.FrameTransforms", "protobuf", &FrameTransforms::schema())?;
        let joint_state = writer.add_schema("sensor_msgs/msg/JointState", "ros2msg", ros::JOINT_STATE.as_bytes())?;
        let string = writer.add_schema("std_msgs/msg/String", "ros2msg", ros::STRING.as_bytes())?;
        let state = writer.add_schema("gyroflex.State", "protobuf", &State::schema())?;
        Ok(Self {
            tf: writer.add_channel(tf, "/tf", "protobuf", &none)?,
            joint_states: writer.add_channel(joint_state, "/joint_states", "cdr", &none)?,
            motor_states: match motors {
                true => Some(writer.add_channel(joint_state, "/motor_states", "cdr", &none)?),
                false => None,
            },
            description: writer.add_channel(string, "/robot_description", "cdr", &none)?,
            state: writer.add_channel(state, "/gyroflex/state", "protobuf", &none)?,
            impacts: match contacts {
                true => {
                    let impact = writer.add_schema("gyroflex.Impact", "protobuf", &proto::Impact::schema())?;
                    Some(writer.add_channel(impact, "/gyroflex/impacts", "protobuf", &none)?)
                }
                false => None,
            },
        })
    }
}

fn media_type(name: &str) -> &'static str {
    match Path::new(name).extension().and_then(|e| e.to_str()) {
        Some("urdf" | "xacro" | "xml") => "application/xml",
        Some("yaml" | "yml") => "application/yaml",
        Some("csv") => "text/csv",
        _ => "text/plain",
    }
}

fn error(name: &str, e: McapError) -> Error {
    match e {
        McapError::Io(source) => file::write_error(name, &source),
        McapError::AttemptedWriteAfterFailure => {
            let problem = "ends where an earlier write failed, without its index".to_owned();
            file::io_error(name, problem, "restore the index with `mcap recover`; what was written before is readable")
        }
        other => file::write_error(name, &io::Error::other(other)),
    }
}
