#!/usr/bin/env bash
# Makes a web site of README, docs and the interfaces of C++, C and Python, to be opened from the disk or
# put on any server: make_site.sh [BUILD_DIR], default build/release. It is written to BUILD_DIR/site. The
# page on Python is made of the module that BUILD_DIR has, and is left out where it has none.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

build=$(realpath -m "${1:-build/release}")
install_packages "${site_packages[@]}"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{ cat docs/site/Doxyfile; echo "OUTPUT_DIRECTORY = $work"; } | doxygen -

# The pages as they stand, and beside them one for each public header.
mkdir -p "$work/pages/api/cpp"
ln -s "$PWD"/{README,CHANGELOG,CONTRIBUTING}.md "$PWD"/{LICENSE,CITATION.cff,docs,examples,scenarios,scripts} \
  "$work/pages"
{
  printf '# C++\n\n[embedding.md](../docs/embedding.md) says which header holds what.\n'
  printf '\n```{toctree}\n:glob:\n\ncpp/*\n```\n'
} >"$work/pages/api/cpp.md"
(cd core/include && ls railcast/*.h railcast/io/*.h) | while read -r header; do
  page=api/cpp/$(basename "$header" .h).md
  if [[ "$header" == railcast/c_api.h ]]; then page=api/c.md; fi
  # shellcheck disable=SC2016  # Backquotes of Markdown.
  printf '# `%s`\n\n```{doxygenfile} %s\n```\n' "$header" "$header" >"$work/pages/$page"
done
printf '# Python\n\n' >"$work/pages/api/python.md"
if [[ -e "$build/python/railcast" ]]; then
  printf '```{eval-rst}\n.. automodule:: railcast\n   :members:\n   :imported-members:\n   :undoc-members:\n```\n'
else
  echo "The page on Python's module is left out: $build has none" >&2
  printf 'This site was made without the module. [python.md](../docs/python.md) is about it.\n'
fi >>"$work/pages/api/python.md"

site=$work/site
RAILCAST_DOXYGEN_XML="$work/xml" PYTHONPATH="$build/python" PYTHONDONTWRITEBYTECODE=1 \
  sphinx-build -q -W --keep-going -c docs/site -d "$work/doctrees" "$work/pages" "$site"
echo '<meta http-equiv="refresh" content="0; url=README.html">' >"$site/index.html"

# Debian's furo lacks what its own build does: its script is no module, and dark systems get its dark colours.
theme=$site/_static/scripts/furo.js
colors=$site/_static/styles/furo.css
{ cat "$site/_static/scripts/gumshoe-patched.js"; sed '/^import Gumshoe /d' "$theme"; } >"$work/furo.js"
cp "$work/furo.js" "$theme"
sed -n '/^@media not print {$/,/} }$/{
  s/@media not print/@media screen and (prefers-color-scheme: dark)/
  s/\[data-theme="dark"\]/:not([data-theme="light"])/
  p
}' "$colors" >"$work/dark.css"
# It also lacks the style sheet that takes away the margins which browsers give to pages.
{ cat "$work/dark.css"; echo 'body{margin:0}'; } >>"$colors"

# Pictures load fast on phones: WebP, at most 200 kB each.
most_bytes=200000
for picture in "$site"/_images/*.{png,jpg}; do
  webp=${picture%.*}.webp
  if [[ -e "$webp" ]]; then
    echo "two pictures have the name of $picture" >&2
    exit 1
  fi
  cwebp -quiet -q 82 "$picture" -o "$webp"
  if (($(stat -c %s "$webp") >= most_bytes)); then
    cwebp -quiet -size $((most_bytes * 9 / 10)) -pass 8 "$picture" -o "$webp"
  fi
  rm "$picture"
done
find "$site" -name '*.html' -exec sed -i -E 's#(_images/[^"]+)\.(png|jpg)"#\1.webp"#g' {} +

rm -rf "$build/site"
mkdir -p "$build"
cp -r "$site" "$build/site"
echo "$build/site/index.html"
