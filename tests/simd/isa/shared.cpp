// What the comparison of a baseline object with a wide one must find: without LEAK the weak function that both share
// does no floating-point arithmetic.
inline __attribute__((noinline)) int count(const int* p, int n) { return n > 0 ? p[0] + n : 0; }
inline __attribute__((noinline)) float sum(const float* p) { return p[0] + p[1]; }

int use(const int* p) { return count(p, 3); }
float square(float x) { return x * x; }
#if LEAK == 1
float use(const float* p) { return sum(p); }
#endif
