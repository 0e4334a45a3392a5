// A type of the library passed between units of different flags: the one that defines the function is built for newer
// CPUs. As the names carry the flags, the linker does not find it; with the same flags it does.
#include <textplane/core/se3.hpp>

double length(const textplane::SE3d& T);

#if defined(TEXTPLANE_TEST_DEFINES)
double length(const textplane::SE3d& T) { return T.t.norm(); }
#else
int main() { return length(textplane::SE3d()) > 0; }
#endif
