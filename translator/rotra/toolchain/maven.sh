#!/bin/sh
# Run Maven without the network where it has all it needs, with the network where it says that it has not.
# In: a stamp file that tells that this goal has once run to its end with these poms, then Maven's arguments.
set -eu

stamp=$1
shift
poms="pom.xml model/java/pom.xml agents/java/pom.xml"
record=$(mktemp -d)
trap 'rm -rf "$record"' EXIT

# Shows what Maven says (less the colour codes it prints even when told not to), keeps it, gives back its exit status.
maven() {
    { status=0; mvn -B -ntp -Dstyle.color=never "$@" 2>&1 || status=$?; echo "$status" >"$record/status"; } |
        sed -u 's/\x1b\[[0-9;]*m//g; /^$/d' | tee "$record/log"
    return "$(cat "$record/status")"
}

if [ -e "$stamp" ] && [ -z "$(find $poms -newer "$stamp")" ]; then
    status=0
    maven -o "$@" || status=$?
    [ "$status" = 0 ] && exit 0
    grep -q 'in offline mode' "$record/log" || exit "$status"
    echo "==> something is missing offline; once more with the network"
fi
maven "$@"
mkdir -p "$(dirname "$stamp")"
touch "$stamp"
