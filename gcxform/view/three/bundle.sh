#!/usr/bin/env bash
# Makes three.min.js of what parts.js names. Needs npm; works in a folder of its own.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save three@0.187.0 esbuild@0.28.2
cp "$here/parts.js" .
node_modules/.bin/esbuild parts.js --bundle --minify --format=iife --global-name=THREE \
    --legal-comments=none --outfile="$here/three.min.js"
cp node_modules/three/LICENSE "$here/LICENSE"
