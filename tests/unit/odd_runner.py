"""Stands in for the process that maps a recording; does what the map's name says."""

import json
import os
import signal
import sys
import time

name = json.loads(sys.stdin.readline())["name"]
if name == "is-killed":
    os.kill(os.getpid(), signal.SIGKILL)
elif name == "grows":
    held = bytearray(300_000_000)
    held[::4096] = bytes(len(held[::4096]))
    time.sleep(60)
elif name == "sleeps":
    time.sleep(60)
elif name == "babbles":
    print("all went well")
elif name == "raises":
    raise SystemExit("no such pumpkin")
else:
    print("a library's chatter")
    threads = int(os.environ["OMP_NUM_THREADS"])
    print(json.dumps({"frames": 7, "things": threads}))
