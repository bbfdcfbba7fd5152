"""Compares an MCAP log with the CSV of the same run, to the last bit.

    check_log.py RUN.mcap RUN.csv GEAR_RATIO...

One gear ratio a joint, in the order of the CSV; `-` for a joint without a drive. The log is read with the libraries its
users have (PyPI: mcap, mcap-ros2-support, mcap-protobuf-support), by the schemas in the log alone.
"""

import csv
import math
import sys

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory as ProtobufDecoder
from mcap_ros2.decoder import DecoderFactory as Ros2Decoder

PER_JOINT = [
    "q", "qd", "qdd", "theta", "thetad", "thetadd", "deflection",
    "tau_j", "tau", "gyroscopic", "friction", "reference", "tracking_error",
]
WHOLE = ["kinetic_energy", "gravity_energy", "elastic_energy", "power_in", "dissipation", "significance"]


class Checker:
    """Rows of the CSV by column name, and a count of the numbers compared with them."""

    def __init__(self, path, ratios):
        with open(path, newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        self.names = [cell.rsplit(" [", 1)[0] for cell in header]
        self.rows = [dict(zip(self.names, map(float, row), strict=True)) for row in rows]
        self.joints = [name[len("q."):] for name in self.names if name.startswith("q.")]
        self.driven = [
            (joint, float(ratio)) for joint, ratio in zip(self.joints, ratios, strict=True) if ratio != "-"
        ]
        self.compared = 0
        self.seen = set()
        self.impacts = 0

    def equal(self, what, value, expected):
        assert value == expected, f"{what}: {value!r} in the log, {expected!r} expected"
        self.compared += 1

    def column(self, row, name, value):
        self.equal(name, value, row[name])
        self.seen.add(name)

    def pose(self, row, prefix, position, rotation):
        for axis in "xyz":
            self.column(row, f"{prefix}.{axis}", getattr(position, axis))
        for axis in "xyzw":
            self.column(row, f"{prefix}.q{axis}", getattr(rotation, axis))

    def state(self, row, message):
        self.column(row, "time", message.time)
        self.equal("joints", [joint.name for joint in message.joints], self.joints)
        for joint in message.joints:
            for key in PER_JOINT:
                self.column(row, f"{key}.{joint.name}", getattr(joint, key))
        for key in WHOLE:
            self.column(row, key, getattr(message, key))
        floating = "base.x" in self.names
        self.equal("floating root", message.HasField("base"), floating)
        if floating:
            base = message.base
            self.pose(row, "base", base.position, base.orientation)
            for axis in "xyz":
                self.column(row, f"base.w{axis}", getattr(base.angular_velocity, axis))
                self.column(row, f"base.v{axis}", getattr(base.linear_velocity, axis))

        held = "constraint_drift" in self.names
        self.equal("footing", message.HasField("footing"), held)
        if held:
            self.footing(row, message.footing)
        for mode in message.modes:
            for key in ("eta", "etad", "etadd"):
                self.column(row, f"{key}.{mode.name}", getattr(mode, key))
        for tip in message.tips:
            for axis in "xyz":
                self.column(row, f"tip.{tip.link}.{axis}", getattr(tip.displacement, axis))
                self.column(row, f"tip.{tip.link}.r{axis}", getattr(tip.rotation, axis))

    def footing(self, row, footing):
        for contact in footing.contacts:
            for axis in "xyz":
                self.column(row, f"contact.{contact.name}.f{axis}", getattr(contact.force, axis))
            for key in ("gap", "mode"):
                self.column(row, f"contact.{contact.name}.{key}", getattr(contact, key))
        for axis in "xyz":
            self.column(row, f"center_of_mass.{axis}", getattr(footing.center_of_mass, axis))
        for axis in "xy":
            self.column(row, f"zero_moment_point.{axis}", getattr(footing.zero_moment_point, axis))
        self.column(row, "constraint_drift", footing.constraint_drift)

    def impact(self, message, log_time):
        assert abs(log_time - message.time * 1e9) <= 1, "impact: log time"
        known = {name[len("contact."):-len(".gap")] for name in self.names if name.endswith(".gap")}
        assert message.contacts and {contact.name for contact in message.contacts} <= known, "impact: contacts"
        for contact in message.contacts:
            for vector in (contact.impulse, contact.velocity_before, contact.velocity_after):
                assert all(math.isfinite(getattr(vector, axis)) for axis in "xyz"), "impact: numbers"
        assert math.isfinite(message.energy_lost), "impact: energy"
        self.impacts += 1

    def transforms(self, row, message):
        frames = {t.child_frame_id: t for t in message.transforms}
        for t in message.transforms:
            assert t.parent_frame_id == "world" or t.parent_frame_id in frames, f"{t.child_frame_id} hangs nowhere"
            stamp = t.timestamp.seconds + t.timestamp.nanos * 1e-9
            assert abs(stamp - row["time"]) <= 1e-9, f"stamp {stamp} at {row['time']} s"
            self.pose(row, f"frame.{t.child_frame_id}", t.translation, t.rotation)
            norm = sum(getattr(t.rotation, axis) ** 2 for axis in "xyzw")
            assert abs(norm - 1) < 1e-14, f"{t.child_frame_id}: no unit quaternion"

    def joint_states(self, row, message):
        self.equal("names", list(message.name), self.joints)
        for i, joint in enumerate(self.joints):
            self.equal(joint, message.position[i], row[f"q.{joint}"])
            self.equal(joint, message.velocity[i], row[f"qd.{joint}"])
            self.equal(joint, message.effort[i], row[f"tau_j.{joint}"])

    def motor_states(self, row, message):
        self.equal("names", list(message.name), [joint for joint, _ in self.driven])
        for i, (joint, ratio) in enumerate(self.driven):
            self.equal(joint, message.position[i], ratio * row[f"theta.{joint}"])
            self.equal(joint, message.velocity[i], ratio * row[f"thetad.{joint}"])
            self.equal(joint, message.effort[i], row[f"tau.{joint}"] / ratio)


def main(log, table, ratios):
    checker = Checker(table, ratios)
    checks = {
        "/gyroflex/state": checker.state,
        "/tf": checker.transforms,
        "/joint_states": checker.joint_states,
    }
    if checker.driven:
        checks["/motor_states"] = checker.motor_states
    counts = dict.fromkeys(checks, 0)
    with open(log, "rb") as file:
        reader = make_reader(file, decoder_factories=[ProtobufDecoder(), Ros2Decoder()])
        assert reader.get_summary() is not None, "no index"
        descriptions = 0
        for decoded in reader.iter_decoded_messages():
            topic, message = decoded.channel.topic, decoded.decoded_message
            if topic == "/robot_description":
                assert message.data.lstrip().startswith("<"), "no URDF"
                descriptions += 1
                continue
            if topic == "/gyroflex/impacts":
                checker.impact(message, decoded.message.log_time)
                continue
            row = checker.rows[counts[topic]]
            assert abs(decoded.message.log_time - row["time"] * 1e9) <= 1, f"{topic}: log time"
            checks[topic](row, message)
            counts[topic] += 1
        assert descriptions == 1, f"{descriptions} robot descriptions"
        assert all(count == len(checker.rows) for count in counts.values()), f"{counts} for {len(checker.rows)} rows"
        assert checker.seen == set(checker.names), f"not in the log: {set(checker.names) - checker.seen}"
        attachments = [a.name for a in reader.iter_attachments()]
        assert attachments, "no attachments"
        assert any(m.name == "gyroflex" for m in reader.iter_metadata()), "no metadata"
    print(
        f"{checker.compared} numbers of {len(checker.rows)} samples equal; {checker.impacts} impacts; "
        f"attachments {attachments}"
    )


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
