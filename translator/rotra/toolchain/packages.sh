#!/bin/sh
# Debian packages that the build needs and that are not there: installed when we are root, else named in one line.
# In: the machine; the argument `tests` asks for what only the tests use, too.  Exit status: 0 all there, 1 something is missing (the line on stderr says what to type).
set -eu

wanted=${1:-}
missing=""
program() { command -v "$1" >/dev/null 2>&1 || missing="$missing $2"; }
header() { printf '#include <stdio.h>\n#include <%s>\n' "$1" | cc -E -o /dev/null - >/dev/null 2>&1 || missing="$missing $2"; }

built() {
    for binary in .build/nusmv/bin/NuSMV "${XDG_CACHE_HOME:-$HOME/.cache}"/rotra/nusmv-*/bin/NuSMV; do
        [ -x "$binary" ] && return 0
    done
    return 1
}

look() {
    missing=""
    program "${PYTHON:-python3}" python3
    "${PYTHON:-python3}" -c 'import ensurepip, venv' >/dev/null 2>&1 || missing="$missing python3-venv"
    program javac openjdk-17-jdk-headless
    program mvn maven
    program cc gcc
    # Only a build of NuSMV needs these; a binary that is there already, here or in the user's cache, does not.
    if ! built; then
        program gcc gcc
        program g++ g++
        program flex flex
        program bison bison
        program patch patch
        program unzip unzip
        header expat.h libexpat1-dev
        header readline/readline.h libreadline-dev
    fi
    [ "$wanted" != tests ] || program swipl swi-prolog-nox
    missing=$(printf '%s\n' $missing | sort -u | tr '\n' ' ' | sed 's/ *$//')
}

look
[ -z "$missing" ] && exit 0
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1; then
    echo "==> installing Debian packages: $missing"
    log=.build/packages.log
    mkdir -p .build
    if ! { DEBIAN_FRONTEND=noninteractive apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing; } >"$log" 2>&1 </dev/null; then
        tail -n 3 "$log" >&2
    fi
    look
    [ -z "$missing" ] && exit 0
fi
echo "missing packages; type: apt-get install -y $missing   (as root, once; then make again)" >&2
exit 1
