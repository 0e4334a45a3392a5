TEXTPLANE_SIMD_ENTRY int region_number() noexcept { return static_cast<int>(simd::Target::TEXTPLANE_SIMD_REGION); }
TEXTPLANE_SIMD_ENTRY int lane_count() noexcept { return kLanes; }
