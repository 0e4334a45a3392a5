// What each of the two libraries does, in its own namespace: see unit.cpp.
#ifndef TWO_FLAGS_UNIT_HPP
#define TWO_FLAGS_UNIT_HPP

#define TWO_FLAGS_DECLARE(name) \
  namespace name {              \
  double number();              \
  const char* target();         \
  bool set_target_scalar();     \
  const char* baseline();       \
  }
TWO_FLAGS_DECLARE(plain)
TWO_FLAGS_DECLARE(wide)

#endif  // TWO_FLAGS_UNIT_HPP
