#include "renderer/sign_plate.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace textslam {

namespace {

constexpr double kPlateDensity = 1000.0;  // texels per metre
constexpr double kRim = 0.06;

const char* const kWords[] = {"EXIT",   "LIBRARY", "OFFICE",   "PARKING", "COFFEE",  "MUSEUM",   "KITCHEN",  "STATION",
                              "GARDEN", "TICKETS", "LIFT",     "DANGER",  "CAUTION", "PHARMACY", "BAKERY",   "HOTEL",
                              "SCHOOL", "THEATRE", "MARKET",   "POLICE",  "TOILETS", "STAIRS",   "ENTRANCE", "OPEN",
                              "CLOSED", "WELCOME", "WORKSHOP", "ARCHIVE", "STUDIO",  "GALLERY",  "NOTICE",   "PRIVATE",
                              "ROOM",   "TAXI",    "BUS",      "METRO",   "AIRPORT", "CINEMA",   "BOOKS",    "FLOWERS",
                              "MUSIC",  "SPORTS",  "DENTIST",  "DOCTOR",  "BANK",    "POST",     "CAFE",     "SILENCE"};

}  // namespace

SignPlate make_sign_plate(const std::string& word, double width, const std::vector<Font>& fonts, Random& random) {
  const Font& font = fonts[static_cast<std::size_t>(random.below(static_cast<int>(fonts.size())))];
  const double ink_width = random.uniform(0.74, 0.84) * width * kPlateDensity;
  // Ink is as wide as the height says: draw once to learn the ratio, then at the size wanted.
  const Ink trial = font.draw(word, 100.0);
  if (trial.empty()) throw std::invalid_argument("no glyph for the word " + word);
  const Ink ink = font.draw(word, 100.0 * ink_width / trial.width());

  const bool light_on_dark = random.chance(0.45), border = random.chance(0.55);
  const double paper = light_on_dark ? random.uniform(25.0, 70.0) : random.uniform(190.0, 225.0);
  const double letters = light_on_dark ? random.uniform(195.0, 235.0) : random.uniform(15.0, 55.0);
  const double margin = 0.5 * (width * kPlateDensity - ink.width());
  const double height = (ink.height() + 2.0 * std::min(margin, 0.55 * ink.height())) / kPlateDensity;
  Canvas paint(width, height, kPlateDensity, paper);
  if (border) {
    const double inset = random.uniform(0.008, 0.016), thick = random.uniform(0.006, 0.011);
    for (const double at : {inset, -1.0}) {
      const double x = at > 0.0 ? at : width - inset, y = at > 0.0 ? at : height - inset;
      paint.rectangle(x, 0.5 * height, 0.5 * thick, 0.5 * height - inset + 0.5 * thick, 0.0, letters);
      paint.rectangle(0.5 * width, y, 0.5 * width - inset + 0.5 * thick, 0.5 * thick, 0.0, letters);
    }
  }
  Image<float>& pixels = paint.pixels();
  Image<std::uint8_t> mask(pixels.width(), pixels.height());
  const int left = (pixels.width() - ink.width()) / 2, top = (pixels.height() - ink.height()) / 2;
  for (int y = 0; y < ink.height(); ++y) {
    for (int x = 0; x < ink.width(); ++x) {
      mask(left + x, top + y) = ink(x, y);
      float& p = pixels(left + x, top + y);
      p += static_cast<float>(ink(x, y)) / 255.0F * (static_cast<float>(letters) - p);
    }
  }
  const std::uint64_t dirt = random.word();
  paint.apply([dirt](double x, double y, double v) {
    return v + 5.0 * fractal_noise(6.0 * x, 6.0 * y, dirt, 4) + 3.0 * value_noise(220.0 * x, 220.0 * y, dirt + 1);
  });
  const Vector2<double> d = paint.density();
  const double rim = kRim * ink.height();
  return {std::move(paint),
          std::move(mask),
          (left - rim) / d[0],
          (top - rim) / d[1],
          (ink.width() + 2.0 * rim) / d[0],
          (ink.height() + 2.0 * rim) / d[1]};
}

std::vector<std::string> sign_words(int count, Random& random) {
  std::vector<std::string> words(std::begin(kWords), std::end(kWords));
  if (count < 0 || count > static_cast<int>(words.size()))
    throw std::invalid_argument("too many signs for the list of words");
  for (int i = 0; i < count; ++i) {
    std::swap(words[static_cast<std::size_t>(i)],
              words[static_cast<std::size_t>(i + random.below(static_cast<int>(words.size()) - i))]);
  }
  words.resize(static_cast<std::size_t>(count));
  return words;
}

}  // namespace textslam
