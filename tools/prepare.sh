# Sourced by tools/run, tools/test and .ci/run: brings a Debian machine to where they can start.
# Afterwards ROOT is the checkout and PYTHON the interpreter of its virtual environment.

ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
PYTHON="$ROOT/.venv/bin/python"

say() { printf '%s: %s\n' "${TOOL:-tools}" "$*" >&2; }

has_library() { # NAME.so.N
    PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null | grep -qF "$1 "
}

# The Debian packages whose effect is missing, one a line. $1: run or test.
missing_packages() {
    python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || echo python3
    python3 -c 'import ensurepip, venv' 2>/dev/null || echo python3-venv
    has_library libX11.so.6 || echo libx11-6 # imgui-bundle links it, headless too
    has_library libEGL.so.1 || echo libegl1
    has_library libGL.so.1 || echo libgl1 # brings Mesa's drivers
    if [ "$1" = test ]; then
        has_library libatomic.so.1 || echo libatomic1 # mitsuba links it
        command -v Xvfb >/dev/null || echo xvfb
        command -v xdotool >/dev/null || echo xdotool
        command -v glslangValidator >/dev/null || echo glslang-tools
    fi
}

# Installs what is missing as root; else says what to type and stops. $1: run or test.
install_system_packages() {
    local missing command
    missing="$(missing_packages "$1" | tr '\n' ' ')"
    missing="${missing% }"
    [ -n "$missing" ] || return 0
    command="apt-get install -y --no-install-recommends $missing"
    if ! command -v apt-get >/dev/null; then
        say "missing, by their Debian names: $missing"
        exit 1
    fi
    if [ "$(id -u)" -ne 0 ]; then
        say "packages are missing; install them and try again:"
        printf '    sudo apt-get update && sudo %s\n' "$command" >&2
        exit 1
    fi
    say "installing $missing"
    export DEBIAN_FRONTEND=noninteractive
    # shellcheck disable=SC2086 # the list is meant to split
    { apt-get update -qq && apt-get install -y -qq --no-install-recommends $missing; } >/dev/null || {
        say "failed: $command"
        exit 1
    }
}

# A checkout's .venv with the package in it, editable. $1: "" or the extra "dev".
# The stamp names everything that the environment depends on, so a second call takes milliseconds.
install_python_packages() {
    local extra="$1" stamp="$ROOT/.venv/stamp" wanted
    wanted="$ROOT $(python3 -c 'import sys; print(sys.version.split()[0])') $(
        cat "$ROOT/pyproject.toml" "$ROOT/setup.py" | sha256sum | cut -d' ' -f1
    )"
    if [ -f "$stamp" ]; then
        case "$(cat "$stamp")" in
        "$wanted dev") return 0 ;; # holds all that running needs
        "$wanted $extra") return 0 ;;
        esac
    fi
    say "making .venv (a minute or two the first time)"
    rm -f "$stamp"
    [ -x "$PYTHON" ] && "$PYTHON" -m pip --version >/dev/null 2>&1 ||
        python3 -m venv --clear "$ROOT/.venv" || exit 1
    "$PYTHON" -m pip install --quiet --disable-pip-version-check \
        -e "$ROOT${extra:+[$extra]}" >&2 || {
        say "pip could not install the package"
        exit 1
    }
    printf '%s %s\n' "$wanted" "$extra" >"$stamp"
}

# $1: run or test
prepare() {
    install_system_packages "$1"
    case "$1" in
    run) install_python_packages "" ;;
    test) install_python_packages dev ;;
    esac
}
