// MSVC's, of which clang's <intrin.h> needs the type alone; MinGW's declares _setjmp otherwise.
typedef int jmp_buf[64];
