"""Labels given to stripped and shuffled recordings, by models of other people."""
