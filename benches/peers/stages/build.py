"""Where everything lives, what is installed, and how every program is built."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent
REPOSITORY = HERE.parent.parent
HOME = Path(os.environ.get("GYROFLEX_PEERS") or Path.home() / ".cache/gyroflex/peers")
PYTHON = HOME / "venv/bin/python"
MODELS = HOME / "models"
BIN = HOME / "bin"
GENERATED = HOME / "generated"

# Pinned, so that a table says what it measured. cmeel-* are the headers Pinocchio needs.
PACKAGES = ["pin==4.1.0", "libpinocchio==4.1.0", "cmeel-eigen==3.4.1", "cmeel-boost==1.90.0",
            "example-robot-data==6.0.0", "mujoco==4.0.0", "casadi==3.8.2"]
# Without the preprocessed lists of Boost, which are too short for Pinocchio's list of joints.
BOOST = ["-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
         "-DBOOST_FUSION_INVOKE_MAX_ARITY=12"]
CXX_FLAGS = ["-std=c++17", "-O3", "-DNDEBUG"]
ARCHITECTURES = ["native", "x86-64-v3"]

# Robots that straight-line code is generated for.
ARMS = ["panda", "panda_flex", "ur5", "ur5_flex"]
C_FLAGS = ["-O3"]
COMPILERS = {"gcc": "g++", "clang": "clang++"}


def call(*command, **more):
    try:
        subprocess.run([str(word) for word in command], check=True, **more)
    except FileNotFoundError:
        sys.exit(f"`{command[0]}` is not installed")
    except subprocess.CalledProcessError as error:
        sys.exit(f"`{command[0]}` failed with code {error.returncode}, see above")


def nice(*command, **more):
    call("nice", "-n", "10", *command, **more)


def install(_):
    missing = [tool for tool in ("clang++", "g++", "cargo") if not shutil.which(tool)]
    if missing:
        sys.exit(f"install {' and '.join(missing)} first (Debian: apt-get install clang g++ cargo)")
    if not PYTHON.exists():
        call(sys.executable, "-m", "venv", HOME / "venv")
    call(PYTHON, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *PACKAGES)


def models(_):
    call(PYTHON, HERE / "stages/models.py", MODELS)


def site_packages():
    return next((HOME / "venv/lib").glob("python3*/site-packages"), None) or sys.exit("run the stage `install` first")


def programs():
    """Name, and how to build it from scratch, of every program."""
    yield "gyroflex", lambda: gyroflex(None)
    yield "mujoco", mujoco
    for architecture in ARCHITECTURES:
        yield f"gyroflex-{architecture}", lambda a=architecture: gyroflex(a)
        yield f"rust-peers-{architecture}", lambda a=architecture: rust_peers(a)
        yield f"pinocchio-{architecture}", lambda a=architecture: pinocchio(a)


def generators():
    """The same of what writes straight-line code, which it does right away."""
    yield "casadi-generator", casadi_generator
    yield "gyroflex-generator", gyroflex_generator


def straight_line_programs():
    for architecture in ARCHITECTURES:
        for compiler in COMPILERS:
            yield f"straight-line-{compiler}-{architecture}", lambda c=compiler, a=architecture: straight_line_c(c, a)
        yield f"straight-line-rustc-{architecture}", lambda a=architecture: straight_line_rust(a)


def build(options):
    BIN.mkdir(parents=True, exist_ok=True)
    for name, make in [*programs(), *generators(), *straight_line_programs()]:
        if options.only in name:
            print(f"building {name}", flush=True)
            make()


def cargo(folder, target, architecture, arguments, program, name, **variables):
    environment = {key: value for key, value in os.environ.items() if key != "RUSTFLAGS"} | variables
    environment["CARGO_TARGET_DIR"] = str(HOME / target)
    if architecture:
        environment["RUSTFLAGS"] = f"-C target-cpu={architecture}"
    nice("cargo", "build", "--quiet", "--release", *arguments, cwd=folder, env=environment)
    shutil.copy2(HOME / target / "release" / program, BIN / name)


def gyroflex(architecture):
    """As a user of the crate gets it: the release profile, without flags or with one."""
    suffix = f"-{architecture}" if architecture else ""
    cargo(REPOSITORY, f"target-gyroflex{suffix}", architecture, ["-p", "gyroflex-benches", "--bin", "peer"], "peer",
          f"gyroflex{suffix}")


def rust_peers(architecture):
    cargo(HERE / "rust", f"target-rust-{architecture}", architecture, ["--locked"], "gyroflex-peers",
          f"rust-peers-{architecture}")


def pinocchio_headers():
    include = site_packages() / "cmeel.prefix/include"
    return [*BOOST, "-isystem", include, "-isystem", include / "eigen3"]


def pinocchio(architecture):
    nice("clang++", *CXX_FLAGS, f"-march={architecture}", *pinocchio_headers(), HERE / "cpp/pinocchio.cpp", "-o",
         BIN / f"pinocchio-{architecture}")


def mujoco():
    folder = site_packages() / "mujoco"
    library = next(folder.glob("libmujoco.so.*"))
    # The library is as its wheel brings it; what is compiled here only calls it.
    nice("clang++", *CXX_FLAGS, "-march=x86-64-v3", "-isystem", folder / "include", HERE / "cpp/mujoco.cpp", "-o", BIN / "mujoco",
         library, f"-Wl,-rpath,{folder}")


def casadi_generator():
    folder, program = site_packages() / "casadi", BIN / "casadi-generator"
    # It runs once, so its own speed is not worth the compiler's time.
    nice("g++", "-std=c++17", "-O0", "-DNDEBUG", *pinocchio_headers(), "-isystem", folder / "include", HERE / "cpp/casadi.cpp",
         "-o", program, f"-L{folder}", "-lcasadi", f"-Wl,-rpath,{folder}")
    (GENERATED / "casadi").mkdir(parents=True, exist_ok=True)
    call(program, MODELS, GENERATED / "casadi", *ARMS)


def gyroflex_generator():
    """As a user of the command line gets it."""
    cargo(REPOSITORY, "target-gyroflex", None, ["-p", "gyroflex-cli"], "gyroflex", "gyroflex-generator")
    for arm in ARMS:
        for language in ("c", "rust"):
            found = subprocess.run(
                [BIN / "gyroflex-generator", "codegen", MODELS / f"{arm}.yaml", "--what", "forward,inverse", "--model", "complete",
                 "--lang", language, "--name", arm, "--json", "-o", GENERATED / "gyroflex"], stdout=subprocess.PIPE, text=True)
            if found.returncode:
                sys.exit(f"`gyroflex codegen` failed with code {found.returncode}, see above")
        # The counts are those of the functions, whatever the language.
        (GENERATED / "gyroflex" / f"{arm}.json").write_text(found.stdout)
    modules = [f'#[path = "{GENERATED}/gyroflex/{arm}.rs"]\nmod {arm};\n' for arm in ARMS]
    (GENERATED / "gyroflex/arms.rs").write_text("".join(modules))


def straight_line_c(compiler, architecture):
    name = f"straight-line-{compiler}-{architecture}"
    flags, objects, folder = [*C_FLAGS, f"-march={architecture}"], [], HOME / f"objects-{compiler}-{architecture}"
    folder.mkdir(exist_ok=True)
    sources = [GENERATED / f"casadi/{arm}_{algorithm}.c" for arm in ARMS for algorithm in ("aba", "rnea")]
    for source in [*sources, *(GENERATED / f"gyroflex/{arm}.c" for arm in ARMS)]:
        objects.append(folder / f"{source.parent.name}-{source.stem}.o")
        nice(compiler, *flags, "-c", source, "-o", objects[-1])
    nice(COMPILERS[compiler], *CXX_FLAGS, f"-march={architecture}", "-I", GENERATED / "gyroflex", HERE / "cpp/straight_line.cpp",
         *objects, "-o", BIN / name)


def straight_line_rust(architecture):
    cargo(HERE / "straight-line", f"target-straight-line-{architecture}", architecture, ["--locked"], "gyroflex-straight-line",
          f"straight-line-rustc-{architecture}", GENERATED=str(GENERATED / "gyroflex"))
