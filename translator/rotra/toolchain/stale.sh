#!/bin/sh
# Remove the stamp of everything that was built once but is no longer there.  In: the project's folder.  Silent.
[ -x .venv/bin/python ] || rm -f .build/venv.stamp .build/python.stamp
[ -x .venv/bin/rotra ] || rm -f .build/python.stamp
[ -x .build/nusmv/bin/NuSMV ] || rm -f .build/nusmv.stamp
list=agents/java/target/classpath.txt
[ -s "$list" ] && [ -d agents/java/target/classes ] && [ -d model/java/target/classes ] || rm -f .build/jvm.stamp
if [ -s "$list" ]; then
    tr ':' '\n' <"$list" | while IFS= read -r jar; do
        [ -e "$jar" ] || rm -f .build/jvm.stamp .build/maven-*.stamp
    done
fi
exit 0
