# None but those of the core.
