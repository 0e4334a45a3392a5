// The operations of windows in the region that includes this file (see foreach_target.inl). A group is eight words of a v16, 128
// bits.
//
//   kTapWindows          whether the target has them; where not, they do nothing
//   load_cells(p)        load16(p), once: g++ would load them again for each use
//   group_ends(last)     what share16() takes to give all words of a group its first, or its last
//   share16(v, ends)     the same
//   below16(v, high)     the lesser, both unsigned
//   above16(v, n)        v - n where that is positive, v unsigned; else 0
//   picks16(x)           the bytes x and x + 1 of a row of 16, of each word, 0 <= x <= 14
//   pick16(row, picks)   these bytes of the group's row
//   find_windows(x, y, stride)  the offset y stride + x of each group, x and y being those of the first group's window
//   load_rows(p, at)     rows of 16 bytes at p + the offset of each group
//   either16(y, a, b)    a where y is 0, else b
//   any_of_four(v)       bit i: one of the words 4 i .. 4 i + 3 is not 0
//   load_group(p)        the eight words at p, and others; store_group(p, v) stores them alone
//   group_offsets(x, y, stride, out)  y stride + x of eight cells; the stride fits int16
//   fetch_group(upper, lower, offset, a, b)  of these, as gather16()
//   store_taps(p, a, b)  k16Lanes times a word of a and above it one of b, in order
//
// windows_x86.inl makes spread() and window_words() of them, which is what kernels call. On the other targets, where single loads
// are as fast or were not measured, there are none.
#if TEXTPLANE_SIMD_REGION == 2
#include "textplane/simd/windows_avx2.inl"
#include "textplane/simd/windows_x86.inl"
#elif TEXTPLANE_SIMD_REGION == 3
#include "textplane/simd/windows_avx512.inl"
#include "textplane/simd/windows_x86.inl"
#else
#include "textplane/simd/windows_none.inl"
#endif
