# SPDX-License-Identifier: GPL-3.0-or-later
"""shaders_used.py SHADERS SOURCES: whether every file of SHADERS is part of a source in SOURCES."""

import pathlib
import sys

shaders, sources = map(pathlib.Path, sys.argv[1:])
texts = [path.read_text() for path in sources.glob('*.glsl')]
unused = []
for path in sorted(shaders.iterdir()):
    if path.suffix not in ('.glsl', '.vert', '.frag', '.comp'):
        continue
    # An include is replaced by another file; what stands between includes is handed on as it is.
    lines = path.read_text().splitlines()
    parts = '\n'.join('\0' if line.startswith('#include') else line for line in lines).split('\0')
    if not any(all(part.strip() in text for part in parts) for text in texts):
        unused.append(path.name)
sys.exit(f"in none of {len(texts)} sources: {', '.join(unused)}" if unused or not texts else 0)
