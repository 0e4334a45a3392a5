// ClassicalParameters: all thresholds of the classical text detector in one place.
//
// Lengths without a unit are shares of the letters' or the line's height; "level px" are pixels of the searched pyramid
// level. ink_sigmas, min_variety, min_score and the limits of ink, cover, lean and quad height were tuned on a rendered
// room (seed 1), kitchen video and street photographs: results on those flatter the detector.
#ifndef TEXTSLAM_DETECTORS_CLASSICAL_PARAMETERS_HPP
#define TEXTSLAM_DETECTORS_CLASSICAL_PARAMETERS_HPP

namespace textslam {

struct ClassicalParameters {
  // The pyramid: each level finds letters of about the same size in its own pixels.
  int levels = 4;     ///< at most; a level has at least min_side px on its shorter side
  int min_side = 80;  ///< level px

  // Ink: pixels that differ from the mean of their window by `ink_sigmas` standard deviations and by `ink_floor`.
  int window_radius = 8;  ///< level px; strokes wider than this break up and are left to the next level
  double ink_sigmas = 0.5;
  double ink_floor = 5.0;  ///< grey levels

  // A letter: a connected piece of ink.
  int min_size = 7, max_size = 72;  ///< level px, of the longer side of the bounding box
  int min_area = 14;                ///< level px^2
  double max_aspect = 8.0;          ///< longer over shorter side
  double min_extent = 0.12;         ///< area over bounding box
  int max_holes = 4;                ///< B has two; letters that touch enclose more
  double min_contrast = 18.0;       ///< grey levels between ink and paper beside it
  double max_paper_spread = 0.4;    ///< standard deviation of the paper beside the letter, over the contrast
  double max_ink_spread = 0.4;      ///< standard deviation of the ink, over the contrast
  double max_stroke_spread = 0.55;  ///< standard deviation over mean of the stroke's half width along its ridge
  double max_stroke = 0.5;          ///< stroke width over the longer side

  // Two letters side by side.
  double max_angle = 60.0;        ///< degrees of the line from the horizontal; pairs may exceed it by half of max_turn
  double max_height_ratio = 2.0;  ///< across the line
  double max_stroke_ratio = 2.0;
  double min_overlap = 0.5;          ///< of their extents across the line, over the smaller
  double max_gap = 0.9;              ///< over the larger height
  double min_gap = -0.3;             ///< italics and A V overlap
  double max_tone_difference = 0.4;  ///< of ink and of paper, over the contrast

  // A line of letters.
  int min_letters = 3;
  double max_turn = 25.0;  ///< degrees between the line and its next letter
  double max_offset =
      0.4;  ///< of a letter's centre from the line: small letters stand on its base or hang from its top
  double angle_tolerance = 1.0;  ///< degrees beyond max_angle for a whole line: noise decides no line at the limit
  double slope_distance = 0.4;   ///< of the line's length, between two letters whose slope counts
  double ragged = 0.08;          ///< residual above which a side takes the slope of the other one
  double lean_step = 0.05;       ///< of the search for the lean, in
  int lean_steps = 24;           ///< steps, right and left by turns,
  double lean_penalty = 0.1;     ///< of the squared lean on the letters' width
  double max_residual = 0.12;    ///< median distance of the letters' tops or bottoms (the better of both) from a line
  double max_taper = 1.8;        ///< ratio of the heights at both ends
  double max_lean = 0.5;         ///< tangent of the angle between the sides and the normal of the line
  double min_height = 5.0;       ///< level px, of the letters, across the line
  double max_quad_height = 2.3;  ///< over the letters' median height: ascenders and descenders, no more
  double min_cover = 0.6,
         max_cover = 1.12;                ///< sum of the letters' widths over the quad's: gaps and overlaps are small
  double min_ink = 0.15, max_ink = 0.58;  ///< part of the quad's area that is ink: from thin to fat print
  double bar_fill = 0.82;                 ///< a letter that fills more of its box is a mere bar
  double max_bars = 0.5;                  ///< share of bars
  double min_variety = 0.03;              ///< letters differ in width (over height) or fill; windows and tiles do not
  double max_line_tone_spread = 0.25;     ///< standard deviation of the letters' ink and paper, over the contrast
  double margin = 0.06;                   ///< added around the ink
  double min_score = 0.38;  ///< 0.4 to 0.6 is a clear word of three letters, 0.9 a long line of even capitals

  double score_letters = 0.3;   ///< how fast the score grows with the letters,
  double score_tones = 2.0;     ///< and falls with uneven tones,
  double score_taper = 0.5;     ///< taper
  double score_residual = 2.0;  ///< and residual
  double level_penalty = 0.9;   ///< factor on each coarser level: the finer level is more exact

  // Quads that share more than this part of the smaller one show the same text; the better one stays.
  double max_shared_area = 0.4;
};

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_CLASSICAL_PARAMETERS_HPP
