#!/usr/bin/env bash
# Instructions per call of the algorithms on iiwa14, counted by valgrind's callgrind: the difference between 200 and 100
# calls, so that loading the robot does not count. The same binary gives the same counts, whatever else the machine does.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build -q --release -p gyroflex-benches --bin instructions
program=${CARGO_TARGET_DIR:-target}/release/instructions
count() { valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$1" "$2" 2>&1 | sed -n 's/.*Collected : //p'; }
printf '%-24s %s\n' case 'instructions per call'
for case in {aba,rnea,crba}:{links,complete,reduced,rigid,rigid_reflected}; do
  printf '%-24s %d\n' "$case" $((($(count "$case" 200) - $(count "$case" 100)) / 100))
done
