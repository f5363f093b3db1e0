#!/usr/bin/env python3
"""Checks a log, its releases and their signatures, using only the documents and independently of `arcade`.

    pip install cryptography py_ecc
    python3 tools/scripts/trust/check.py --log log --log-key log.pub --keys trust/keys-1.json --releases releases

Only Ed25519 requires a package outside the standard library. BLAKE3 is implemented below, based on its paper. The package py_ecc
checks the signatures of drand rounds. Without py_ecc, the script checks only that each value is the hash of its signature, and the
last line of the output says so.

Prints every problem, followed by the checked items. The exit status is 1 if there is a problem. The script replays no episodes and
mints nothing, because `arcade verify` and `arcade regenerate` do so.
"""

import argparse
import base64
import functools
import hashlib
import json
import struct
import sys
from pathlib import Path

from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

try:
    from py_ecc.bls import G2Basic
    from py_ecc.bls.g2_primitives import pubkey_to_G1, subgroup_check
    from py_ecc.bls.hash_to_curve import hash_to_G1
    from py_ecc.bls.point_compression import decompress_G2
    from py_ecc.optimized_bls12_381 import G2, is_inf, pairing
except ImportError:
    G2Basic = None

# ---- BLAKE3 (hash and key derivation) ----

IV = (0x6A09E667, 0xBB67AE85, 0x3C6EF372, 0xA54FF53A, 0x510E527F, 0x9B05688C, 0x1F83D9AB, 0x5BE0CD19)
ORDER = (2, 6, 3, 10, 7, 0, 4, 13, 1, 11, 12, 5, 9, 14, 15, 8)
SCHEDULE = [tuple(range(16))]
for _ in range(6):
    SCHEDULE.append(tuple(SCHEDULE[-1][at] for at in ORDER))
LANES = ((0, 4, 8, 12), (1, 5, 9, 13), (2, 6, 10, 14), (3, 7, 11, 15),
         (0, 5, 10, 15), (1, 6, 11, 12), (2, 7, 8, 13), (3, 4, 9, 14))
START, END, PARENT, ROOT, CONTEXT, MATERIAL = 1, 2, 4, 8, 32, 64


def compress(chaining, words, counter, length, flags):
    v = [*chaining, *IV[:4], counter & 0xFFFFFFFF, counter >> 32, length, flags]
    for schedule in SCHEDULE:
        for lane, (a, b, c, d) in enumerate(LANES):
            x, y = words[schedule[2 * lane]], words[schedule[2 * lane + 1]]
            va, vb, vc, vd = v[a], v[b], v[c], v[d]
            va = va + vb + x & 0xFFFFFFFF
            vd ^= va
            vd = (vd >> 16 | vd << 16) & 0xFFFFFFFF
            vc = vc + vd & 0xFFFFFFFF
            vb ^= vc
            vb = (vb >> 12 | vb << 20) & 0xFFFFFFFF
            va = va + vb + y & 0xFFFFFFFF
            vd ^= va
            vd = (vd >> 8 | vd << 24) & 0xFFFFFFFF
            vc = vc + vd & 0xFFFFFFFF
            vb ^= vc
            vb = (vb >> 7 | vb << 25) & 0xFFFFFFFF
            v[a], v[b], v[c], v[d] = va, vb, vc, vd
    return tuple(v[at] ^ v[at + 8] for at in range(8))


def blake3(data, key=IV, flags=0):
    def chunk(data, counter, last):
        chaining = key
        blocks = [data[at:at + 64] for at in range(0, len(data), 64)] or [b""]
        for at, block in enumerate(blocks):
            words = struct.unpack("<16I", block.ljust(64, b"\0"))
            is_end = at + 1 == len(blocks)
            kind = flags | (START if at == 0 else 0) | ((END | last) if is_end else 0)
            chaining = compress(chaining, words, counter, len(block), kind)
        return chaining

    def tree(data, counter, last):
        if len(data) <= 1024:
            return chunk(data, counter, last)
        split = 1024
        while 2 * split < len(data):
            split *= 2
        left, right = tree(data[:split], counter, 0), tree(data[split:], counter + split // 1024, 0)
        return compress(key, left + right, 0, 64, flags | PARENT | last)

    return struct.pack("<8I", *tree(data, 0, ROOT))


def derive(context, data):
    key = struct.unpack("<8I", blake3(context.encode(), flags=CONTEXT))
    return blake3(data, key, MATERIAL)


# ---- canonical JSON, in which numbers keep their text ----


class Number(str):
    """A number that keeps its original text."""


def unique(pairs):
    keys = [key for key, _ in pairs]
    if len(set(keys)) != len(keys):
        raise ValueError("a key occurs twice")
    return dict(pairs)


def parse(data):
    return json.loads(data, parse_float=Number, parse_int=Number, object_pairs_hook=unique)


def is_scalar(value):
    return not isinstance(value, (list, dict))


def canonical(value, indent=0):
    inner, outer = "\n" + "  " * (indent + 1), "\n" + "  " * indent
    if isinstance(value, Number):
        return str(value)
    if is_scalar(value):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list) and all(map(is_scalar, value)):
        return "[" + ", ".join(canonical(item) for item in value) + "]"
    if isinstance(value, list):
        return "[" + ",".join(inner + canonical(item, indent + 1) for item in value) + outer + "]"
    if not value:
        return "{}"
    items = sorted(value.items(), key=lambda item: item[0].encode())
    line = lambda key, item: f"{inner}{json.dumps(key, ensure_ascii=False)}: {canonical(item, indent + 1)}"
    return "{" + ",".join(line(key, item) for key, item in items) + outer + "}"


def text_of(value):
    return (canonical(value) + "\n").encode()


def document(data):
    value = parse(data)
    if text_of(value) != data:
        raise ValueError("is not canonical JSON")
    return value


# ---- keys and signatures of minisign ----


def unbase(text):
    """Decodes a text in base64, which must be in its canonical form."""
    data = base64.b64decode(text, validate=True)
    if base64.b64encode(data).decode() != text:
        raise ValueError("is not canonical base64")
    return data


class Key:
    def __init__(self, line):
        data = unbase(line)
        if len(data) != 42 or data[:2] != b"Ed":
            raise ValueError("is not a minisign public key")
        self.line, self.number, self.point = line, data[2:10], data[10:]
        self.key = Ed25519PublicKey.from_public_bytes(self.point)

    @staticmethod
    def read(path):
        return Key([line for line in Path(path).read_text().splitlines() if line.strip()][-1])

    def holds(self, signature, message):
        try:
            self.key.verify(signature, message)
            return True
        except InvalidSignature:
            return False

    def signed(self, message, signature):
        """Returns whether the text of a .minisig file is a signature of the message under this key."""
        try:
            _, line, comment, whole = signature.rstrip("\n").split("\n")
            data, whole = unbase(line), unbase(whole)
        except ValueError:
            return False
        prefix = "trusted comment: "
        if len(data) != 74 or data[:2] != b"ED" or data[2:10] != self.number or not comment.startswith(prefix):
            return False
        digest = hashlib.blake2b(message).digest()
        return self.holds(data[10:], digest) and self.holds(whole, data[10:] + comment[len(prefix):].encode())


class Keys:
    """The sets of keys that follow from a trusted set."""

    def __init__(self, path, problems):
        path = Path(path)
        self.sets = {}
        data = path.read_bytes()
        self.add(document(data), data)
        number = self.newest
        while (later := path.with_name(f"keys-{number + 1}.json")).exists():
            data, signatures = later.read_bytes(), signatures_of(later)
            found, before = document(data), self.sets[number][0]
            enough = all(
                self.count(group, data, signatures) >= int(group["threshold"]) for group in (before, found)
            )
            gone = {key["key"] for key in before["revoked"]} - {key["key"] for key in found["revoked"]}
            if int(found["version"]) != number + 1 or found["previous"] != self.sets[number][1] or gone or not enough:
                problems.append(f"{later.name}: does not follow keys-{number}.json, or lacks signatures")
                return
            number += 1
            self.add(found, data)

    def add(self, found, data):
        self.newest = int(found["version"])
        self.sets[self.newest] = (found, blake3(data).hex())

    @staticmethod
    def count(found, message, signatures, revoked=()):
        keys = [Key(key["key"]) for key in found["keys"] if key["key"] not in revoked]
        return sum(any(key.signed(message, text) for text in signatures) for key in keys)

    def accept(self, statement, message, signatures):
        """Returns the reason why a statement is not signed as required, if there is one."""
        keys = statement["keys"]
        found, digest = self.sets.get(int(keys["version"]), (None, None)) if keys else (None, None)
        if found is None or digest != keys["digest"]:
            return "it does not specify a set of keys that follows from the trusted set"
        revoked = {key["key"] for key in self.sets[self.newest][0]["revoked"]}
        for group in (found, self.sets[self.newest][0]):
            count = self.count(group, message, signatures, revoked)
            if count < int(group["threshold"]):
                return f"signed by {count} keys of set {group['version']}, but {group['threshold']} must sign"
        return None


def signatures_of(path):
    return [found.read_text(errors="replace") for found in sorted(path.parent.glob(path.name + "*.minisig"))]


# ---- the log ----


def sha(*parts):
    return hashlib.sha256(b"".join(parts)).digest()


def root_of(hashes):
    if not hashes:
        return sha()
    if len(hashes) == 1:
        return hashes[0]
    split = 1
    while 2 * split < len(hashes):
        split *= 2
    return sha(b"\1", root_of(hashes[:split]), root_of(hashes[split:]))


def tile_path(level, number, width):
    name = f"{number % 1000:03}"
    while number >= 1000:
        number //= 1000
        name = f"x{number % 1000:03}/{name}"
    return f"tile/{level}/{name}" + ("" if width == 256 else f".p/{width}")


def tiles(count):
    return [(at, min(256, count - 256 * at)) for at in range((count + 255) // 256)]


def read_log(folder, key, problems):
    """Returns the entries of a log as bytes."""
    folder = Path(folder)
    body, _, signatures = (folder / "checkpoint").read_bytes().decode().partition("\n\n")
    origin, size, root = body.split("\n")
    name = sha(f"{origin}\n\1".encode(), key.point)[:4]
    *lines, end = signatures.split("\n")
    lines = [line.split(" ") for line in lines]
    if end or any(len(line) != 3 or line[0] != "\u2014" for line in lines):
        raise ValueError("is not a checkpoint")
    signed = [unbase(data) for _, who, data in lines if who == origin]
    if not any(data[:4] == name and key.holds(data[4:], (body + "\n").encode()) for data in signed):
        problems.append("the checkpoint is not signed by the log's key")
    entries = []
    for number, width in tiles(int(size)):
        data = (folder / tile_path("entries", number, width)).read_bytes()
        for _ in range(width):
            length = int.from_bytes(data[:2], "big")
            entries.append(data[2:2 + length])
            data = data[2 + length:]
        if data:
            problems.append("there are bytes after the last entry of a tile")
    level, hashes = 0, [sha(b"\0", entry) for entry in entries]
    if root_of(hashes) != unbase(root):
        problems.append("the entries do not match the signed checkpoint")
    while hashes:
        for number, width in tiles(len(hashes)):
            if (folder / tile_path(level, number, width)).read_bytes() != b"".join(hashes[256 * number:][:width]):
                problems.append(f"{tile_path(level, number, width)}: does not match the entries")
        hashes = [root_of(hashes[at:at + 256]) for at in range(0, len(hashes) - 255, 256)]
        level += 1
    return [document(entry) for entry in entries]


def commitment(seed, nonce, recipe):
    data = struct.pack("<Q", len(seed)) + seed.encode() + bytes.fromhex(nonce) + bytes.fromhex(recipe)
    return derive("infinite-arcade 2 commitment", data).hex()


# ---- rounds of drand ----

NETWORKS = {
    "drand quicknet": (
        "bls-unchained-g1-rfc9380",
        "83cf0f2896adee7eb8b5f01fcad3912212c437e0073e911fb90022d3e760183c8c4b450b6a0a6c3ac6a5776a2d106451"
        "0d1fec758c921cc22b0e17e63aaf4bcb5ed66304de9cf809bd274ca73bab4af5a6e9c76a4bc09e76eae8991ef5ece45a",
    ),
    "drand default": (
        "pedersen-bls-chained",
        "868f005eb8e6e4ca0a47c8a77ceaa5309a47978a7c71bc5cce96366b5d7a569937c529eeda66c7293784a9402801af31",
    ),
}


def chain_hash(chain):
    data = struct.pack(">Iq", int(chain["period"]), int(chain["genesis_time"]))
    data += bytes.fromhex(chain["public_key"]) + bytes.fromhex(chain["groupHash"])
    name = chain["metadata"]["beaconID"]
    return hashlib.sha256(data + (b"" if name == "default" else name.encode())).hexdigest()


@functools.cache
def holds_on_curve(scheme, key, message, signature):
    """Returns whether a BLS signature on the curve BLS12-381 is valid."""
    try:
        if scheme != "bls-unchained-g1-rfc9380":
            return len(signature) == 96 and G2Basic.Verify(key, message, signature)
        if (len(key), len(signature)) != (96, 48):
            return False
        key = decompress_G2((int.from_bytes(key[:48], "big"), int.from_bytes(key[48:], "big")))
        point = pubkey_to_G1(signature)
        if is_inf(key) or is_inf(point) or not (subgroup_check(key) and subgroup_check(point)):
            return False
        hashed = hash_to_G1(message, b"BLS_SIG_BLS12381G1_XMD:SHA-256_SSWU_RO_NUL_", hashlib.sha256)
        return pairing(key, hashed) == pairing(G2, point)
    except (ValueError, AssertionError):
        return False


def fault_of_round(source, number, value, proof):
    """Returns the reason why a value does not belong to a round, if there is one."""
    if proof and hashlib.sha256(bytes.fromhex(proof["signature"])).hexdigest() != value:
        return "the value is not the hash of the signature"
    if "drand" not in source.lower():
        return None
    if not proof:
        return "a drand round has no signature"
    scheme, key = NETWORKS.get(source, (None, None))
    chain = proof.get("chain")
    if (scheme is None) == (chain is None):
        return "the network's key is unknown, or it is given although it is known"
    if chain:
        if source != "drand " + chain_hash(chain) or chain["hash"] != chain_hash(chain):
            return "its network has a different hash"
        if chain["public_key"] in [known for _, known in NETWORKS.values()]:
            return "its network must be specified by its name"
        scheme, key = chain["schemeID"], chain["public_key"]
    previous = proof.get("previous_signature")
    if scheme not in ("bls-unchained-g1-rfc9380", "pedersen-bls-unchained", "pedersen-bls-chained"):
        return f"the scheme {scheme} is unknown"
    if (previous is not None) != (scheme == "pedersen-bls-chained"):
        return "the previous round's signature is missing, or present although the network is not chained"
    message = hashlib.sha256(bytes.fromhex(previous or "") + struct.pack(">Q", number)).digest()
    if G2Basic and not holds_on_curve(scheme, bytes.fromhex(key), message, bytes.fromhex(proof["signature"])):
        return "the signature is not the network's"
    return None


def check_history(entries, problems):
    """Checks the rules that the entries must obey together. Returns the roots by name."""
    keys, commitments, beacons, roots, results = None, {}, {}, {}, set()
    for number, entry in enumerate(entries):
        kind, name = entry["kind"], entry.get("release")
        wrong = lambda text: problems.append(f"entry {number}: {text}")
        round_of = lambda part: (part["source"], int(part["round"])) if part else None
        if kind == "keys":
            expect = (1, None) if keys is None else (keys[0] + 1, keys[1])
            if (int(entry["version"]), entry["previous"]) != expect:
                wrong("a set of keys does not follow the previous set")
            keys = (int(entry["version"]), entry["digest"])
        elif kind == "commitment":
            awaited = round_of(entry["beacon"])
            if name in commitments or name in roots:
                wrong(f"a second commitment for {name}, or a commitment after its root")
                continue
            if awaited in beacons:
                wrong(f"the beacon of {name} was known before the commitment")
            if awaited and any(round_of(other["beacon"]) == awaited for other in commitments.values()):
                wrong(f"the beacon of {name} is also specified by another commitment")
            commitments[name] = entry
        elif kind == "beacon":
            source, round_number = round_of(entry["round"])
            if fault := fault_of_round(source, round_number, entry["value"], entry.get("proof")):
                wrong(f"round {round_number} of {source}: {fault}")
            if beacons.setdefault(round_of(entry["round"]), entry["value"]) != entry["value"]:
                wrong("a round has two values")
        elif kind == "root":
            before = commitments.get(name)
            if name in roots or any(other["root"] == entry["root"] for other in roots.values()):
                wrong(f"a second root for {name}, or its root under a different name")
                continue
            if entry["parent"] and all(other["root"] != entry["parent"] for other in roots.values()):
                wrong(f"the parent of {name} is not in the log")
            if (before["commitment"] if before else None) != entry["commitment"]:
                wrong(f"{name} has a different commitment than the log")
            if before and before["parent"] != entry["parent"]:
                wrong(f"{name} has a different parent than its commitment states")
            awaited = round_of(before["beacon"]) if before else None
            if (beacons.get(awaited) if awaited else None) != entry["beacon"] or (awaited and awaited not in beacons):
                wrong(f"{name} was not minted with the value of its beacon")
            roots[name] = entry
        elif name not in roots or roots[name]["root"] != entry["root"]:
            wrong(f"refers to a release that is not in the log: {name}")
        elif kind == "reveal":
            if commitment(entry["seed"], entry["nonce"], entry["recipe"]) != roots[name]["commitment"]:
                wrong(f"the secret of {name} does not match its commitment")
            if commitments[name]["recipe"] != entry["recipe"]:
                wrong(f"the secret of {name} was drawn for a different recipe")
        elif kind == "result":
            if entry["results"] in results:
                wrong("the results are already in the log")
            results.add(entry["results"])
    return roots


# ---- releases ----


def check_release(folder, roots, keys, problems):
    manifest = document((folder / "MANIFEST.json").read_bytes())
    name, items = manifest["name"], manifest["items"]
    wrong = lambda text: problems.append(f"{folder.name}: {text}")
    for item in items:
        path = folder / item["path"]
        data = path.read_bytes()
        if len(data) != int(item["size"]) or blake3(data).hex() != item["digest"]:
            wrong(f"{item['path']} does not match the manifest")
    there = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    extra = {path for path in there if not path.startswith("papers/")} - {item["path"] for item in items}
    if extra != {"MANIFEST.json"}:
        wrong(f"contains files that the manifest does not list: {sorted(extra)}")
    fields = ("canary", "commitment", "format", "generation", "kind", "name", "parent", "recipe", "semantics", "version")
    leaves = {item["path"]: item["digest"] for item in items}
    leaves["MANIFEST"] = blake3(text_of({field: manifest[field] for field in fields})).hex()
    leaf = lambda path: blake3(
        b"\0" + struct.pack("<Q", len(path.encode())) + path.encode() + bytes.fromhex(leaves[path])
    )
    hashes = [leaf(path) for path in sorted(leaves, key=str.encode)]
    node = lambda left, right: blake3(b"\1" + left + right)

    def merkle(hashes):
        if len(hashes) == 1:
            return hashes[0]
        split = 1
        while 2 * split < len(hashes):
            split *= 2
        return node(merkle(hashes[:split]), merkle(hashes[split:]))

    if merkle(hashes).hex() != manifest["root"]:
        wrong("the root does not match the files")
    numbers = [manifest["root"], manifest["lockfile"], *(item["size"] for item in items)]
    if blake3("".join(f"{number}\n" for number in numbers).encode()).hex() != manifest["checksum"]:
        wrong("the checksum does not match the root, the lock file and the sizes")
    logged = roots.get(name)
    beacon = manifest["recipe"].get("beacon")
    value = beacon["value"] if beacon else None
    stated = (manifest["root"], manifest["parent"], manifest["commitment"], value)
    if logged is None or (logged["root"], logged["parent"], logged["commitment"], logged["beacon"]) != stated:
        wrong("the log does not have this release, or has it with a different root, parent, commitment or beacon")
    secret = folder / "held" / "secret.json"
    if secret.exists():
        secret = parse(secret.read_bytes())
        recipe = {key: item for key, item in manifest["recipe"].items() if key not in ("seed", "commitment", "known")}
        if beacon:
            recipe["beacon"] = {key: item for key, item in beacon.items() if key != "value"}
        if blake3(text_of(recipe)).hex() != secret["recipe"]:
            wrong("the recipe does not match the commitment")
        if commitment(secret["seed"], secret["nonce"], secret["recipe"]) != manifest["commitment"]:
            wrong("the secret does not match the commitment")
    faults, stated, is_signed = [], set(), False
    for path in sorted((folder / "papers" / "signatures").glob("root-*.json")):
        data = path.read_bytes()
        statement = document(data)
        if path.name != f"root-{blake3(data).hex()[:16]}.json":
            faults.append(f"{path.name}: its name does not match its digest")
        elif (statement["release"], statement["root"]) != (name, manifest["root"]):
            faults.append(f"{path.name}: it is about a different release")
        else:
            # A statement whose signers were revoked no longer counts, but the log still contains its digest.
            stated.add(blake3(data).hex())
            fault = keys.accept(statement, data, signatures_of(path))
            if statement["provenance"]["lockfile"] != manifest["lockfile"]:
                fault = "it specifies a different lock file than the manifest"
            is_signed |= fault is None
            faults.extend([f"{path.name}: {fault}"] if fault else [])
    if not is_signed:
        wrong("not signed: " + ("; ".join(faults) or "there is no statement"))
    if logged and logged["statement"] and logged["statement"] not in stated:
        wrong("the statement recorded in the log is missing")
    return name


def check_beacons(folder, entries, problems):
    known = {
        (e["round"]["source"], int(e["round"]["round"])): (e["value"], e.get("proof"))
        for e in entries if e["kind"] == "beacon"
    }
    files = sorted(Path(folder).glob("*.json"))
    for path in files:
        found = parse(path.read_bytes())
        value = found.get("value") or found.get("randomness")
        proof = {key: found[key] for key in ("signature", "previous_signature", "chain") if key in found}
        # The log has already been checked, so a file that agrees with the log is valid.
        if known.get((found["source"], int(found["round"]))) != (value, proof or None):
            problems.append(f"{path.name}: the log does not have this value")
    return len(files)


def check(args):
    problems = []
    entries = read_log(args.log, Key.read(args.log_key), problems)
    roots = check_history(entries, problems)
    keys = Keys(args.keys, problems)
    stated = [entry["digest"] for entry in entries if entry["kind"] == "keys"]
    if stated != [digest for _, digest in sorted(keys.sets.values(), key=lambda pair: int(pair[0]["version"]))]:
        problems.append("the sets of keys in the log do not match those in the folder")
    folders = sorted(path.parent for path in Path(args.releases).glob("*/MANIFEST.json"))
    names = [check_release(folder, roots, keys, problems) for folder in folders]
    if missing := sorted(set(roots) - set(names)):
        problems.append(f"releases in the log that are missing here: {', '.join(missing)}")
    beacons = check_beacons(args.beacons, entries, problems) if args.beacons else 0
    held = f"{len(entries)} entries, {len(names)} releases, {len(keys.sets)} sets of keys, {beacons} beacons"
    rounds = sum("drand" in entry["round"]["source"].lower() for entry in entries if entry["kind"] == "beacon")
    if rounds and not G2Basic:
        held += f" ({rounds} drand rounds checked by hash only: install py_ecc to check their signatures)"
    return problems, held


def arguments(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--log", required=True, help="the log's folder")
    parser.add_argument("--log-key", required=True, help="the log's public key")
    parser.add_argument("--keys", required=True, help="the first set of keys, keys-1.json, with later ones beside it")
    parser.add_argument("--releases", required=True, help="a folder of revealed releases")
    parser.add_argument("--beacons", help="a folder with the values of the beacons")
    return parser.parse_args(argv)


def main():
    if blake3(b"").hex() != "af1349b9f5f9a1a6a0404dea36dcc9499bcb25c9adc112b7cc9a93cae41f3262":
        sys.exit("the BLAKE3 implementation gives a wrong hash")
    try:
        problems, held = check(arguments())
    except (ValueError, KeyError, TypeError, OSError) as error:
        problems, held = [f"a document is missing or malformed: {error!r}"], "not everything"
    for problem in problems:
        print(problem)
    print(f"{held}: {'sound' if not problems else 'NOT sound'}")
    sys.exit(bool(problems))


if __name__ == "__main__":
    main()
