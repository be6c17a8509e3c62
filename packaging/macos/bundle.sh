#!/usr/bin/env bash
# The game as an application for macOS, for both kinds of processors. Written from Apple's and Cargo's documentation, and NOT YET
# RUN: nobody had a Mac at hand. Signed by nobody: macOS asks whoever opens it the first time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
target=${CARGO_TARGET_DIR:-target}
version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml)
name="tamaire-$version-macos"
stage="$target/packages/stage/macos"
rm -rf "$stage" && mkdir -p "$stage"
# The oldest macOS that Rust's standard library and Metal's drivers for both kinds are known to run on.
export MACOSX_DEPLOYMENT_TARGET=11.0
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH

for triple in aarch64-apple-darwin x86_64-apple-darwin; do
    TAMAIRE_LICENCES="$PWD/THIRD-PARTY.md"
    if command -v node > /dev/null; then
        TAMAIRE_LICENCES="$PWD/$stage/licences.txt"
        case "$stage" in /*) TAMAIRE_LICENCES="$stage/licences.txt" ;; esac
        node tools/xtask/web/licences.mjs "$TAMAIRE_LICENCES" "$triple" tamaire fuwafuwa_cli
    fi
    export TAMAIRE_LICENCES
    RUSTFLAGS="--remap-path-prefix=$HOME/.cargo=/cargo --remap-path-prefix=$PWD=/tamaire" \
        cargo build --profile dist --locked --package tamaire --package fuwafuwa_cli --bins --target "$triple"
done

app="$stage/tamaire.app/Contents"
mkdir -p "$app/MacOS" "$app/Resources"
for program in tamaire fuwafuwa; do
    lipo -create -output "$app/MacOS/$program" \
        "$target/aarch64-apple-darwin/dist/$program" "$target/x86_64-apple-darwin/dist/$program"
done
sed "s/@VERSION@/$version/" packaging/macos/Info.plist > "$app/Info.plist"
plutil -lint "$app/Info.plist"
printf 'APPL????' > "$app/PkgInfo"

icons="$stage/tamaire.iconset"
mkdir "$icons"
for size in 16 32 128 256 512; do
    sips -z $size $size game/tamaire/web/icon-512.png --out "$icons/icon_${size}x$size.png" > /dev/null
    # Of 1024 there is no picture: none is better than a blurred one.
    double=$((2 * size))
    [ $double -gt 512 ] || sips -z $double $double game/tamaire/web/icon-512.png --out "$icons/icon_${size}x$size@2x.png" > /dev/null
done
iconutil --convert icns --output "$app/Resources/tamaire.icns" "$icons"
for file in LICENSE-MIT LICENSE-APACHE; do cp "$file" "$app/Resources/"; done
[ ! -e "$stage/licences.txt" ] || cp "$stage/licences.txt" "$app/Resources/"

# Processors by Apple run nothing without a signature, if only one that names nobody.
codesign --force --deep --sign - "$stage/tamaire.app"
codesign --verify --deep --strict "$stage/tamaire.app"
rm -f "$target/packages/$name.zip"
ditto -c -k --keepParent "$stage/tamaire.app" "$target/packages/$name.zip"
ls -l "$target/packages/$name.zip"
