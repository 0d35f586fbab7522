"""What bench/run is made of: running programs, statistics, and one module for each thing that is
measured."""
