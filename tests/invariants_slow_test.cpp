// The Gallery again with 10^6 draws a run.
#define GONIO_SLOW_TESTS
#include "invariants_test.cpp"
