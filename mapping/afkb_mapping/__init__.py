"""The map: graph, grid, association, levelling, registration, rooms, and the run that makes one."""
