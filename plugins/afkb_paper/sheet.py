def sheet(title, uri, table, outcome, steps):
    return ""
