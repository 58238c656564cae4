# None but those of the extra ros.
