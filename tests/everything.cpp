// The whole library in one unit, for programs that look at sources.
#include <textplane/textplane.hpp>
int main() { return 0; }
