"""Maps served to programs and people: a SPARQL 1.1 endpoint and a page, read-only.

Three kinds of processes. The server speaks HTTP and runs no query. The keeper has the maps in
memory and forks. Its children answer, each within limits of time and memory and unable to open
anything; one that exceeds them is killed, and the next is forked.
"""
