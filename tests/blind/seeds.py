"""The benchmark's seeds: development for building and tuning, test for figures that are reported."""

DEVELOPMENT_SEED = 110_001
TEST_SEED = 920_417
SUBSET_SEED = 330_803
TEST_CASES = 680
DEVELOPMENT_CASES = 300
