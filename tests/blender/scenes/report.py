#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""report.py RESULTS: writes RESULTS/report.html of what compare.py left in the folders of the versions."""

import glob
import html
import json
import os
import sys

HEAD = """<!doctype html><meta charset="utf-8"><title>Penumbra beside Cycles</title>
<style>body{font:14px sans-serif;background:#222;color:#ddd;margin:1em}img{image-rendering:pixelated;width:192px}
td,th{padding:2px 6px;vertical-align:top;text-align:left}tr{border-top:1px solid #444}table{border-collapse:collapse}
.bad{color:#f66}.ok{color:#8d8}small{color:#aaa}</style><h1>Penumbra beside Cycles</h1>
<p>Each picture: ours, Cycles', four times the difference. Numbers with their limits: coverage is the mean difference of
alpha, light the RMSE over the mean, position the distance of the centres of light in pixels.</p>
"""


def load(folder):
    """{version: results}"""
    found = {}
    for path in sorted(glob.glob(os.path.join(folder, '*', 'results.json'))):
        with open(path, encoding='utf-8') as file:
            found[os.path.basename(os.path.dirname(path))] = json.load(file)
    return found


def cell(version, row):
    if row is None:
        return "<td><small>not in this version</small></td>"
    pictures = ''.join(f'<img src="{version}/{row["name"]}-{kind}.png" alt="{kind}">'
                       for kind in ('penumbra', 'cycles', 'difference'))
    numbers = ', '.join(f'<span class="{"ok" if value <= limit else "bad"}">{name} {value:.4f} &le; {limit}</span>'
                        for name, (value, limit) in row['errors'].items())
    failure = html.escape(row.get('failure', ''))
    messages = '<br>'.join(html.escape(line) for line in row['messages'])
    return f'<td>{pictures}<br>{numbers} <span class="bad">{failure}</span><br><small>{messages}</small></td>'


def main():
    folder = sys.argv[1]
    versions = load(folder)
    by_name = {}
    for version, results in versions.items():
        for row in results['rows']:
            by_name.setdefault(row['name'], {})[version] = row
    with open(os.path.join(folder, 'report.html'), 'w', encoding='utf-8') as file:
        file.write(HEAD + '<table><tr><th>Scene</th>')
        for version, results in versions.items():
            passed = sum(row['passed'] for row in results['rows'])
            file.write(f"<th>Blender {html.escape(results['version'])}: {passed} of {len(results['rows'])}</th>")
        for name, rows in by_name.items():
            first = next(iter(rows.values()))
            file.write(f'<tr><td><b>{name}</b><br>{html.escape(first["group"])}<br>{html.escape(first["text"])}</td>')
            file.write(''.join(cell(version, rows.get(version)) for version in versions))
        file.write('</table>\n')
    print(os.path.join(folder, 'report.html'))


main()
