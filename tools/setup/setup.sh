#!/bin/bash
# Sets up what the build needs. Quick and silent when there is nothing to do.
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "$top/.deps"
"$top/tools/setup/private_prefix.sh" "$top/.deps"
