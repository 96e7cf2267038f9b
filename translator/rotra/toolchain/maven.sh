#!/bin/sh
# Run Maven without the network where it has all it needs, with the network where it says that it has not.
# In: a stamp file that tells that this goal has once run to its end with these poms, then Maven's arguments.
set -eu

stamp=$1
shift
poms="pom.xml model/java/pom.xml agents/java/pom.xml"
log=$(mktemp)
trap 'rm -f "$log"' EXIT

if [ -e "$stamp" ] && [ -z "$(find $poms -newer "$stamp")" ]; then
    # The pipe would hide the exit status: keep it in a file.
    { status=0; mvn -B -ntp -Dstyle.color=never -o "$@" 2>&1 || status=$?; echo "$status" >"$log.status"; } | tee "$log"
    status=$(cat "$log.status")
    rm -f "$log.status"
    [ "$status" = 0 ] && exit 0
    grep -q 'in offline mode' "$log" || exit "$status"
    echo "==> something is missing offline; once more with the network"
fi
mvn -B -ntp -Dstyle.color=never "$@"
mkdir -p "$(dirname "$stamp")"
touch "$stamp"
