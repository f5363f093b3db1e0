#!/usr/bin/env python3
"""Mints a year of sealed months as a publisher would, and attacks the result.

    pip install cryptography py_ecc
    cargo build --release
    python3 tools/scripts/trust/year.py --arcade target/release/arcade --out year --mutations 1000

For each month, the script logs a commitment, waits for a beacon, mints the release, signs it with two of three keys, reveals its
secret, and logs the release. In July, a key is lost and replaced.

Then, `check.py` in the same folder checks all documents. Each kind of document is altered at random positions, and every alteration
must be rejected. The beacons of January to April are old, real rounds of drand. Later beacons belong to a network whose key the script
creates. Without py_ecc, these beacons are values without a signature.
"""

import argparse
import functools
import hashlib
import json
import random
import shutil
import subprocess
import sys
from pathlib import Path

import check

RECIPE = """name = "{name}"
description = "A month of one game, for tests."
commitment = "{commitment}"

[generated]
games = 1
levels = 1
candidates = 2.0

[criteria]
decision = 200
budget = 240000
depths = [10, 25]
random_plays = 20

[beacon]
source = "{source}"
round = {round}
"""

ROUNDS = [
    ("drand quicknet", 1000, "b44679b9a59af2ec876b1a6b1ad52ea9b1615fc3982b19576350f93447cb1125e342b73a8dd2bacbe47e4b6b63ed5e39"),
    (
        "drand default", 1337,
        "945b08dcb30e24da281ccf14a646f0630ceec515af5c5895e18cc1b19edd65d156b71c776a369af3487f1bc6af106250"
        "0b059e01095cc0eedce91713977d7735cac675554edfa0d0481bb991ed93d333d08286192c05bf6b65d20f23a37fc7bb",
        "80d95247ddf1bb3acf5738497a5f10406be283144603f63d714bb1a44ff6b93285ae2697fffeb50c68862bd9fbecd4b2"
        "04b1798d2686b4ac5d573615031d9d67e6168bde9a7adf1161430a498ca701a25c216aee3e38ffd5290369034fa050a2",
    ),
    ("drand quicknet", 123, "b75c69d0b72a5d906e854e808ba7e2accb1542ac355ae486d591aa9d43765482e26cd02df835d3546d23c4b13e0dfc92"),
    (
        "drand default", 72785,
        "82f5d3d2de4db19d40a6980e8aa37842a0e55d1df06bd68bddc8d60002e8e959eb9cfa368b3c1b77d18f02a54fe047b8"
        "0f0989315f83b12a74fd8679c4f12aae86eaf6ab5690b34f1fddd50ee3cc6f6cdf59e95526d5a5d82aaa84fa6f181e42",
        "a609e19a03c2fcc559e8dae14900aaefe517cb55c840f6e69bc8e4f66c8d18e8a609685d9917efbfb0c37f058c2de88f"
        "13d297c7e19e0ab24813079efe57a182554ff054c7638153f9b26a60e7111f71a0ff63d9571704905d3ca6df0b031747",
    ),
]
SECRET = 31415926535


def beacon(number):
    """Returns the file with the value for which a month waits."""
    if number <= len(ROUNDS):
        source, round, signature, *previous = ROUNDS[number - 1]
        more = {"previous_signature": previous[0]} if previous else {}
    elif check.G2Basic:
        chain = {
            "public_key": check.G2Basic.SkToPk(SECRET).hex(), "period": 30, "genesis_time": 1700000000,
            "groupHash": hashlib.sha256(b"group").hexdigest(), "schemeID": "pedersen-bls-unchained",
            "metadata": {"beaconID": "year"},
        }
        chain["hash"] = check.chain_hash(chain)
        source, round, more = "drand " + chain["hash"], 1000 * number, {"chain": chain}
        signature = check.G2Basic.Sign(SECRET, hashlib.sha256(round.to_bytes(8, "big")).digest()).hex()
    else:
        source, round, signature, more = "made by year.py", 1000 * number, f"{number:064}", {}
    value = hashlib.sha256(bytes.fromhex(signature)).hexdigest()
    return {"source": source, "round": round, "randomness": value, "signature": signature, **more}


class Year:
    def __init__(self, arcade, out):
        self.arcade, self.out = str(Path(arcade).resolve()), Path(out)

    def make(self, months):
        self.out.mkdir(parents=True)
        for folder in ("private", "beacons", "releases"):
            (self.out / folder).mkdir()
        for name in ("ada", "bo", "cy", "di", "log"):
            self.run("trust", "keygen", f"private/{name}", "--no-password")
            shutil.copy(self.out / f"private/{name}.pub", self.out / f"{name}.pub")
        self.run("trust", "keys", "trust", "--threshold", "2", "--add", "ada=ada.pub", "bo=bo.pub", "cy=cy.pub")
        self.signers, self.set = ("ada", "bo"), "trust/keys-1.json"
        self.append("--origin", "example.org/arcade", "--keys", self.set)
        parent = ()
        for number in range(1, months + 1):
            if number == 7:
                self.lose_a_key()
            parent = ("--parent", self.month(f"2027-{number:02}", number, parent))

    def run(self, *args):
        found = subprocess.run([self.arcade, *args], cwd=self.out, capture_output=True, text=True)
        if found.returncode:
            sys.exit(f"arcade {' '.join(args)}: status {found.returncode}\n{found.stdout}{found.stderr}")
        return found.stdout

    def append(self, *args):
        self.run("trust", "log", "append", "log", "--secret", "private/log.key", *args)

    def lose_a_key(self):
        secrets = [f"private/{name}.key" for name in ("ada", "cy")]
        self.run("trust", "keys", "trust", "--revoke", "bo=lost", "--add", "di=di.pub", "--secret", *secrets)
        self.signers, self.set = ("ada", "di"), "trust/keys-2.json"
        self.append("--keys", self.set)
        # Signatures with the lost key no longer count.
        for folder in sorted((self.out / "releases").iterdir()):
            self.sign(f"releases/{folder.name}")

    def sign(self, release):
        self.run("trust", "sign", release, "--keys", self.set, "--secret", *(f"private/{name}.key" for name in self.signers))

    def month(self, name, number, parent):
        recipe, secret, drawn = f"private/{name}.toml", f"private/{name}.secret.json", f"beacons/{name}.json"
        value = beacon(number)
        write = lambda commitment: (self.out / recipe).write_text(
            RECIPE.format(name=name, commitment=commitment, source=value["source"], round=value["round"])
        )
        write("0" * 64)
        said = self.run("release", recipe, "--commit", "--out", secret, *parent)
        write(said.split('commitment = "')[1][:64])
        self.append("--commitment", recipe, *parent)
        (self.out / drawn).write_text(json.dumps(value) + "\n")
        minted = f"private/{name}"
        self.run("release", recipe, "--secret", secret, "--beacon", drawn, "--out", minted, *parent)
        self.sign(f"{minted}/public")
        self.append("--beacon", drawn, "--release", f"{minted}/public")
        released = f"releases/{name}"
        self.run("release", f"{minted}/public", "--reveal", f"{minted}/held", "--out", released)
        self.append("--reveal", released)
        return released

    def arguments(self):
        place = lambda name: str(self.out / name)
        return check.arguments([
            "--log", place("log"), "--log-key", place("log.pub"), "--keys", place("trust/keys-1.json"),
            "--releases", place("releases"), "--beacons", place("beacons"),
        ])

    def is_sound(self):
        try:
            return not check.check(self.arguments())[0]
        except (ValueError, KeyError, TypeError, OSError):
            return False


def documents(out):
    """Returns the files of each kind, with the index of the first byte that a signature or digest covers."""
    after_line = lambda path: path.read_bytes().index(b"\n") + 1
    papers = "releases/*/papers/signatures/"
    size = int((out / "log/checkpoint").read_text().split("\n")[1])
    # The log keeps the tiles of earlier sizes, which its checkpoint does not cover.
    log = [out / "log/checkpoint"]
    log += [out / "log" / check.tile_path(kind, *tile) for kind in ("entries", 0) for tile in check.tiles(size)]
    return {
        "log": [(path, 0) for path in log],
        "beacons": [(path, 0) for path in sorted(out.glob("beacons/*.json"))],
        "manifests": [(path, 0) for path in sorted(out.glob("releases/*/MANIFEST.json"))],
        "secrets": [(path, 0) for path in sorted(out.glob("releases/*/held/secret.json"))],
        "games": [(path, 0) for path in sorted(out.glob("releases/*/games/*/*")) if path.is_file()],
        "sets of keys": [(path, 0) for path in sorted(out.glob("trust/keys-*.json"))],
        "statements": [(path, 0) for path in sorted(out.glob(papers + "root-*.json"))],
        "signatures of sets": [(path, after_line(path)) for path in sorted(out.glob("trust/*.minisig"))],
    }


def attack(year, mutations, chance):
    """Alters documents. Returns the alterations that were accepted."""
    # Nearly all files are the same in each attempt.
    check.blake3 = functools.cache(check.blake3)
    accepted = []
    for kind, files in documents(year.out).items():
        # The first six months do not need a second set of keys.
        if not files:
            continue
        refused = 0
        for _ in range(mutations):
            path, first = chance.choice(files)
            data = path.read_bytes()
            at = chance.randrange(first, len(data))
            altered = bytearray(data)
            altered[at] ^= 1 << chance.randrange(8)
            path.write_bytes(altered)
            if not year.is_sound():
                refused += 1
            else:
                accepted.append(f"{path.relative_to(year.out)}: byte {at} of {len(data)}")
            path.write_bytes(data)
        print(f"{kind}: {refused} of {mutations} alterations rejected", flush=True)
    return accepted


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arcade", required=True, help="the program")
    parser.add_argument("--out", required=True, help="a folder; if it exists, the year in it is attacked")
    parser.add_argument("--months", type=int, default=12)
    parser.add_argument("--mutations", type=int, default=0, help="number of alterations per kind of document")
    parser.add_argument("--seed", default="year")
    args = parser.parse_args()
    year = Year(args.arcade, args.out)
    if not year.out.exists():
        year.make(args.months)
    problems, held = check.check(year.arguments())
    print("\n".join(problems + [held]))
    if problems:
        sys.exit(1)
    accepted = attack(year, args.mutations, random.Random(args.seed)) if args.mutations else []
    for place in accepted:
        print(f"accepted: {place}")
    sys.exit(bool(accepted))


if __name__ == "__main__":
    main()
