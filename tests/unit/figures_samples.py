"""Small tables of categories, rooms and their names, and homes to count."""

from __future__ import annotations

from pathlib import Path

from afkb.figures import Counts, Names, count_rooms

CATEGORIES = """name,label
Bed,bed
Pillow,pillow
Mug,mug
Table,table
"""
SOURCE_NAMES = """category,source,name
Bed,hm3d,bed
Pillow,hm3d,pillow
Pillow,hm3d,cushion
Mug,hm3d,mug
Pillow,matterport,throw#pillow
Bed,matterport,bed
Mug,bddl,mug
Mug,bddl,tea_mug
Table,bddl,breakfast_table
Mug,procthor,Mug
Table,procthor,DiningTable
Mug,virtualhome,mug
Table,virtualhome,table
"""
ROOMS = """name,label
Kitchen,kitchen
Bedroom,bedroom
Porch,porch
UnknownRoom,unknown room
"""
ROOM_NAMES = """room,source,name
Bedroom,hm3d,Bedroom
Kitchen,hm3d,Kitchen
Bedroom,matterport,bedroom
Porch,matterport,porch
Kitchen,bddl,kitchen
"""
HM3D = """scene,region,category_by_votes,objects
A,0,Bedroom,bed:1|pillow:2|cushion:1|yoke:3
A,1,Bedroom,bed:2
A,2,Unknown room,bed:1
A,3,Tie: Bedroom & Kitchen,bed:1
A,4,Kitchen,
B,0,Kitchen,mug:4
B,1,Bedroom,bed:1|pillow:1
"""
MATTERPORT = """building,viewpoint,class_id,class_inferred,objects
M,v1,11,bedroom,bed:1|throw#pillow:2
M,v2,11,bedroom,bed:1
M,v3,11,bedroom,
M,v4,9,porch,bed:1
"""


def write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def tables(folder: Path, **changed: str) -> Path:
    """A folder of tables; texts given by name (`source_names=…`) stand in for the usual ones."""
    texts = {
        "categories/all": CATEGORIES,
        "source_names/all": changed.get("source_names", SOURCE_NAMES),
        "rooms": ROOMS,
        "room_names": changed.get("room_names", ROOM_NAMES),
    }
    for name, text in texts.items():
        write(folder / f"{name}.csv", text)
    return folder


def counted(folder: Path, *texts: str) -> Counts:
    """The counts of tables of rooms with these texts."""
    paths = [write(folder / f"rooms_{i}.csv", text) for i, text in enumerate(texts)]
    return count_rooms(paths, Names.load(tables(folder / "tables")))[0]
