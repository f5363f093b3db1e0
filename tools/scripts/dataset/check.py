"""Opens the two exports of a snapshot, and checks that their content is the same and has the types that their dataset cards state.

    check.py SNAPSHOT JSONL_EXPORT PARQUET_EXPORT
"""

import json
import sys
from pathlib import Path

import datasets
import pandas
import pyarrow
import pyarrow.parquet
import yaml

datasets.disable_progress_bars()

TYPES = {
    "string": pyarrow.string(),
    "int64": pyarrow.int64(),
    "float64": pyarrow.float64(),
    "bool": pyarrow.bool_(),
}


def front(export):
    """Returns the YAML of a dataset card."""
    text = (export / "README.md").read_text(encoding="utf-8")
    assert text.startswith("---\n"), "the card has no YAML"
    return yaml.safe_load(text.split("---\n")[1]), text


def arrow_type(feature):
    """Returns the Arrow type of a feature in the card."""
    if "dtype" in feature:
        return TYPES[feature["dtype"]]
    inside = feature["list"]
    if isinstance(inside, str):
        return pyarrow.list_(TYPES[inside])
    return pyarrow.list_(pyarrow.struct([(field["name"], arrow_type(field)) for field in inside]))


def plain(kind):
    """Returns a type without the names of list elements and without nullability, in which Parquet libraries differ."""
    if pyarrow.types.is_list(kind) or pyarrow.types.is_large_list(kind):
        return pyarrow.list_(plain(kind.value_type))
    if pyarrow.types.is_struct(kind):
        return pyarrow.struct([(field.name, plain(field.type)) for field in kind])
    return pyarrow.string() if pyarrow.types.is_large_string(kind) else kind


def levels_of(snapshot):
    """Yields the content of the release for each level: the card, the level's number, its entry in the card, the
    VGDL, the level's text and the witness.
    """
    for card_file in sorted(snapshot.glob("games/*/card.json")):
        card = json.loads(card_file.read_text(encoding="utf-8"))
        vgdl = (card_file.parent / "game.vgdl").read_text(encoding="utf-8")
        for number, level in enumerate(card["levels"]):
            text = (card_file.parent / f"lvl{number}.txt").read_text(encoding="utf-8")
            witness = card_file.parent / "witness" / f"lvl{number}.json"
            yield card, number, level, vgdl, text, json.loads(witness.read_text(encoding="utf-8"))


def main():
    snapshot, jsonl, parquet = map(Path, sys.argv[1:4])
    manifest = json.loads((snapshot / "MANIFEST.json").read_text(encoding="utf-8"))
    truth = list(levels_of(snapshot))
    rows_of = {}
    for export in (jsonl, parquet):
        card, text = front(export)
        (config,) = card["configs"]
        (data,) = config["data_files"]
        assert data["split"] == "test" and (export / data["path"]).is_file()
        assert card["license"] and card["pretty_name"] and card["size_categories"] and card["task_categories"] and card["tags"]
        assert manifest["canary"] in text and manifest["root"] in text and "arcade verify" in text
        info = card["dataset_info"]
        (split,) = info["splits"]
        assert split["name"] == "test" and split["num_examples"] == len(truth), split
        expected = pyarrow.schema([(feature["name"], arrow_type(feature)) for feature in info["features"]])

        # The dataset is opened as users of `datasets` open it. The card states the locations and types of the rows.
        loaded = datasets.load_dataset(str(export), split="test")
        assert loaded.num_rows == len(truth), (loaded.num_rows, len(truth))
        assert loaded.column_names == expected.names, loaded.column_names
        found = loaded.features.arrow_schema
        for field in expected:
            assert plain(found.field(field.name).type) == field.type, (field, found.field(field.name))
        assert loaded.info.splits["test"].num_examples == len(truth)
        rows_of[export] = loaded.to_list()

        # The dataset is opened as users of pandas open it.
        if data["path"].endswith(".parquet"):
            schema = pyarrow.parquet.read_schema(export / data["path"])
            for field in expected:
                assert plain(schema.field(field.name).type) == field.type, (field, schema.field(field.name))
            metadata = pyarrow.parquet.read_metadata(export / data["path"])
            assert metadata.metadata[b"canary"].decode() == manifest["canary"]
            assert metadata.created_by == "infinite-arcade", metadata.created_by
            frame = pandas.read_parquet(export / data["path"])
        else:
            frame = pandas.read_json(export / data["path"], lines=True)
        assert list(frame.columns) == expected.names and len(frame) == len(truth)
        assert frame["item_id"].is_unique and (frame["canary"] == manifest["canary"]).all()
        print(f"{export.name}: {len(frame)} rows, {len(frame.columns)} columns; card, datasets {datasets.__version__}, "
              f"pandas {pandas.__version__}, pyarrow {pyarrow.__version__} agree")

    ours, theirs = rows_of.values()
    assert ours == theirs, "the two exports differ"
    solutions = "solution" in ours[0]
    for row, (card, number, level, vgdl, text, witness) in zip(ours, truth, strict=True):
        assert row["item_id"] == f"{manifest['name']}/{card['id']}/lvl{number}", row["item_id"]
        assert (row["vgdl"], row["level_text"], row["rules"]) == (vgdl, text, card["rules"])
        assert (row["game_digest"], row["level_digest"]) == (card["digest"], level["digest"])
        assert [len(line) for line in text.splitlines()] == [row["columns"]] * row["rows"]
        ladder = level.get("ladder")
        assert row["difficulty"] == (ladder and ladder["difficulty"]) and row["ease"] == (ladder and ladder.get("ease"))
        assert len(row["ladder"]) == (len(ladder["rungs"]) + len(ladder["held_out"]) if ladder else 0)
        for rung, fared in zip(row["ladder"], (ladder["rungs"] + ladder["held_out"]) if ladder else [], strict=True):
            assert (rung["player"], rung["wins"], rung["plays"]) == (fared["player"], fared["rate"]["wins"], fared["rate"]["plays"])
        assert row["witness_ticks"] == len(witness["episode"]["actions"])
        if solutions:
            assert [action.lower() for action in witness["episode"]["actions"]] == row["solution"]
    known = [sorted({row[name] for row in ours if row[name] is not None}) for name in ("goal_kind", "avatar_kind", "difficulty")]
    print(f"both say the same, and what the release says ({'with' if solutions else 'without'} solutions): {known}")


main()
