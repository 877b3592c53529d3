"""How far two toolpaths are apart, along whole moves."""
