"""How well the detectors see, held against recordings whose truth is known.

One module a part. `NEEDS` names the data that the part needs; `run(asked)` measures and gives plain
numbers, strings, lists and dicts; `table(result)` says them in lines; `parts.py` lists them.
"""
