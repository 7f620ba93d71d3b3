"""What scripts/bench is made of: programs to run, peers, measurements, tables, plots, report."""
