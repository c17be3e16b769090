"""Which marker is which: topological models, label spellings, subjects."""
