// textplane::kernels: the kernels of all targets, compiled once. See textplane/simd/targets.hpp.
#define TEXTPLANE_DEFINE_KERNELS
#include <textplane/textplane.hpp>
