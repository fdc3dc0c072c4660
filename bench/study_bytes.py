#!/usr/bin/env python3
"""Counts what one person of a study loads: the page's own files, and every picture once, as WebP and as PNG.

    bench/study_bytes.py 'http://127.0.0.1:8080/lab?token=...' thesis-2007

Enters the study as a preview, which is never counted. Prints a table in Markdown; 1 MB is 10^6 bytes.
"""
import json
import re
import sys
import urllib.parse
import urllib.request


class Server:
    def __init__(self, address):
        parts = urllib.parse.urlsplit(address)
        self.origin = f"{parts.scheme}://{parts.netloc}"
        self.token = urllib.parse.parse_qs(parts.query)["token"][0]

    def call(self, path, body=None, accept="*/*"):
        headers = {"Authorization": f"Bearer {self.token}", "Accept": accept}
        data = None
        if body is not None:
            data = json.dumps(body).encode()
            headers["Content-Type"] = "application/json"
        request = urllib.request.Request(self.origin + path, data=data, headers=headers)
        with urllib.request.urlopen(request, timeout=300) as reply:
            return reply.headers["Content-Type"], reply.read()

    def document(self, path, body=None):
        return json.loads(self.call(path, body)[1])


def page_files(server, study, version):
    """Bytes of the page and of all that it names, in turn: scripts import scripts."""
    waiting, seen, total = [f"/s/{study}?preview={version}"], set(), 0
    while waiting:
        path = waiting.pop()
        if path in seen:
            continue
        seen.add(path)
        text = server.call(path)[1].decode()
        total += len(text.encode())
        here = path.rsplit("/", 1)[0]
        for name in re.findall(r'(?:href|src)="(/assets/[^"]+)"', text) + re.findall(r'from "([^"]+\.js)"', text):
            waiting.append(here + name[1:] if name.startswith("./") else name)
    return total, len(seen)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    server, study = Server(sys.argv[1]), sys.argv[2]
    version = server.document(f"/api/v1/studies/{study}")["version"]
    person = server.document(f"/api/v1/studies/{study}/participants", {"preview": True, "version": version})
    addresses = [image["url"] for page in person["pages"]
                 for image in page["images"] + ([page["reference"]] if page["reference"] else [])]
    sizes = {"image/webp": [], "image/png": []}
    for address in addresses:
        for kind, list_of_sizes in sizes.items():
            served, content = server.call(address, accept=kind)
            if served != kind:
                print(f"asked for {kind}, got {served}", file=sys.stderr)
            list_of_sizes.append(len(content))
    files, count = page_files(server, study, version)
    print("| | MB per person | kB per picture, smallest to largest |\n|---|---|---|")
    for kind, name in (("image/webp", "lossless WebP"), ("image/png", "PNG")):
        kilobytes = [size / 1e3 for size in sizes[kind]]
        print(f"| {len(addresses)} pictures, {name} | {sum(kilobytes) / 1e3:.2f} | {min(kilobytes):.0f} to {max(kilobytes):.0f} |")
    print(f"| {count} files of the page, not compressed | {files / 1e6:.3f} | |")
    print(f"\nWebP takes {100 * (1 - sum(sizes['image/webp']) / sum(sizes['image/png'])):.0f}% fewer bytes.")


main()
