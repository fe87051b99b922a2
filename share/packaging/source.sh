#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# source.sh -- where these sources come from, one line for --version: the commit, and whether files differ from it; of a
# package the line that it was made with.
cd "$(dirname "$0")/../.." || exit 4
if [ -f SOURCE ]; then
    cat SOURCE
elif commit=$(git rev-parse --short=12 HEAD 2>/dev/null); then
    git diff --quiet HEAD 2>/dev/null || changed=', changed'
    echo "commit $commit${changed-}"
else
    echo "unknown commit"
fi
