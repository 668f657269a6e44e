"""How quickly the page of a large map answers to the hand, in headless Chromium."""
