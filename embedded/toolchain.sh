# Sourced by run: `cross TARGET ARGS…` is cargo for another machine. Uses the installed compiler where it has the target's
# library (`rustup target add TARGET`); else Debian's, which comes with the source of that library, unpacked into target/.

debian=$target_dir/embedded/debian-rust

cross() {
  local target=$1 linker
  shift
  linker=$(find_linker)
  # A cargo variable per target holds what the linker is called.
  export "CARGO_TARGET_$(echo "$target" | tr 'a-z-' 'A-Z_')_LINKER=$linker"
  # Hardware square roots without std are not a stable feature of the compiler.
  if [ -d "$(rustc --print target-libdir --target "$target")" ]; then
    RUSTC_BOOTSTRAP=1 cargo "$@" --target "$target"
  else
    fetch_debian
    RUSTC_BOOTSTRAP=1 RUSTC=$debian/rustc cargo "$@" --target "$target" -Zbuild-std=core
  fi
}

# What compiles for a target, in one line.
compiler_for() {
  if [ -d "$(rustc --print target-libdir --target "$1")" ]; then rustc --version; else "$debian/rustc" --version; fi
}

# rust-lld comes with every rustup toolchain and links for all machines.
find_linker() {
  local lld
  lld=$(rustc --print sysroot)/lib/rustlib/$(rustc -vV | sed -n 's/^host: //p')/bin/rust-lld
  [ -x "$lld" ] || lld=$(command -v ld.lld) || fail "no linker: install a Rust toolchain with rustup, or lld"
  echo "$lld"
}

# Unpacked, not installed: the machine's own rustc stays the only one it has.
fetch_debian() {
  [ ! -x "$debian/rustc" ] || return 0
  command -v apt-get >/dev/null || fail "the compiler has no library for $target: rustup target add $target"
  # Without root the package lists may be old, which is no reason to give up.
  apt-get update -q >/dev/null 2>&1 || true
  local packages unpacked=$debian.partial
  packages=$(apt-get install -s --no-install-recommends rustc-web rust-web-src | awk '/^Inst/ { print $2 }')
  rm -rf "$unpacked" && mkdir -p "$unpacked/deb"
  # shellcheck disable=SC2086 # one word a package
  (cd "$unpacked/deb" && apt-get download -q -o APT::Sandbox::User=root $packages >/dev/null) ||
    fail "Debian's rustc-web cannot be fetched: rustup target add $target"
  for package in "$unpacked"/deb/*.deb; do dpkg -x "$package" "$unpacked"; done
  rm -rf "$unpacked/deb"
  # Only rustc itself shall see the unpacked libraries.
  cat >"$unpacked/rustc" <<WRAPPER
#!/bin/sh
export LD_LIBRARY_PATH="$debian/usr/lib/$(uname -m)-linux-gnu\${LD_LIBRARY_PATH:+:\$LD_LIBRARY_PATH}"
exec "$debian/usr/bin/rustc" "\$@"
WRAPPER
  chmod +x "$unpacked/rustc"
  mv "$unpacked" "$debian"
}
