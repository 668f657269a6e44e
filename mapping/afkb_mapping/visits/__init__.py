"""Days between visits: going on where a run stopped, adding later visits, and what has changed."""
