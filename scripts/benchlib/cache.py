"""Results that never change, kept by what they were computed from."""

import hashlib
import json
import pathlib
import threading


def content_hash(*parts):
    """SHA-256 of files (paths) and of strings."""
    digest = hashlib.sha256()
    for part in parts:
        data = part.read_bytes() if isinstance(part, pathlib.Path) else str(part).encode()
        digest.update(len(data).to_bytes(8, "little") + data)
    return digest.hexdigest()[:32]


class Cache:
    """JSON values in a folder, one file each. Safe to use from several threads."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.lock = threading.Lock()
        self.hits = self.misses = 0

    def get(self, key, compute):
        """The value of `key`; `compute()` makes it when it is not there."""
        path = self.folder / f"{key}.json"
        known = path.exists()
        with self.lock:
            self.hits += known
            self.misses += not known
        if known:
            return json.loads(path.read_text())
        value = compute()
        partial = path.with_suffix(f".{threading.get_ident()}.tmp")
        partial.write_text(json.dumps(value))
        partial.replace(path)
        return value
