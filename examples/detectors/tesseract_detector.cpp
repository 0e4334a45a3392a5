#include "detectors/tesseract_detector.hpp"

#include <tesseract/baseapi.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include <dlfcn.h>

#include "detectors/line_picture.hpp"
#include "io/input_error.hpp"

namespace textslam {
namespace {

constexpr double kLongestLine = 40;  // times its height

struct Word {
  std::string text;
  double confidence;
  int left, top, right, bottom;  // px, the last two beyond the word
  double slope;                  // radians, of its base line
};

// On images of this size Tesseract's OpenMP threads only spin. The number is set through whichever OpenMP Tesseract
// loaded.
void use_one_thread() {
  if (void* set = dlsym(RTLD_DEFAULT, "omp_set_num_threads")) reinterpret_cast<void (*)(int)>(set)(1);
}

std::vector<Word> words_of(tesseract::TessBaseAPI& api, double min_confidence) {
  std::vector<Word> words;
  use_one_thread();
  if (api.Recognize(nullptr) != 0) return words;
  const std::unique_ptr<tesseract::ResultIterator> at(api.GetIterator());
  if (!at) return words;
  do {
    const std::unique_ptr<char[]> text(at->GetUTF8Text(tesseract::RIL_WORD));
    if (!text) continue;
    Word word;
    word.text = word_of(text.get());
    word.confidence = static_cast<double>(at->Confidence(tesseract::RIL_WORD)) / 100;
    if (word.text.empty() || word.confidence < min_confidence) continue;
    if (!at->BoundingBox(tesseract::RIL_WORD, &word.left, &word.top, &word.right, &word.bottom)) continue;
    int x1 = 0, y1 = 0, x2 = 1, y2 = 0;
    const bool based = at->Baseline(tesseract::RIL_WORD, &x1, &y1, &x2, &y2) && x2 > x1;
    word.slope = based ? std::atan2(y2 - y1, x2 - x1) : 0;
    words.push_back(word);
  } while (at->Next(tesseract::RIL_WORD));
  return words;
}

// The rectangle along the base line that has the word's bounding box. Beyond 35 degrees that box hardly determines it.
Quad<double> along_base_line(const Word& word) {
  const double w = word.right - word.left, h = word.bottom - word.top;
  double c = std::cos(word.slope), s = std::abs(std::sin(word.slope));
  double wide = (w * c - h * s) / (c * c - s * s), high = (h * c - w * s) / (c * c - s * s);
  double turn = word.slope;
  if (std::abs(turn) > 0.6 || !(wide > 0) || !(high > 0.3 * std::min(w, h))) {
    turn = 0;
    wide = w;
    high = h;
  }
  const Vector2<double> along(std::cos(turn), std::sin(turn)), down(-along.y(), along.x());
  const Vector2<double> centre((word.left + word.right - 1) / 2.0, (word.top + word.bottom - 1) / 2.0);
  const Vector2<double> a = wide / 2 * along, d = high / 2 * down;
  Quad<double> quad;
  quad.corner = {centre - a - d, centre + a - d, centre + a + d, centre - a + d};
  return quad;
}

void show(tesseract::TessBaseAPI& api, const Image<std::uint8_t>& picture, tesseract::PageSegMode mode) {
  api.SetPageSegMode(mode);
  api.SetImage(picture.row(0), picture.width(), picture.height(), 1, static_cast<int>(picture.view().stride()));
  api.SetSourceResolution(150);
}

}  // namespace

Tesseract::Tesseract(const TesseractParameters& parameters)
    : parameters_(parameters), api_(std::make_unique<tesseract::TessBaseAPI>()) {
  api_->SetVariable("debug_file", "/dev/null");  // where it tells of errors; they are passed on here
  if (api_->Init(nullptr, parameters_.language.c_str(), tesseract::OEM_LSTM_ONLY) != 0)
    throw InputError("tesseract", 0,
                     "no data for the language '" + parameters_.language + "' (Debian: tesseract-ocr-" +
                         parameters_.language + "; TESSDATA_PREFIX names another folder)");
}

Tesseract::~Tesseract() = default;

std::vector<Detection> Tesseract::detect(const FrameRef&, ImageView8 raw_image) {
  if (!raw_image.valid()) return {};
  const double zoom = parameters_.zoom;
  const auto back = [&](double v) { return (v + 0.5) / zoom - 0.5; };
  Image<std::uint8_t> picture(static_cast<int>(zoom * raw_image.width()), static_cast<int>(zoom * raw_image.height()));
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) picture(x, y) = grey_at(raw_image, back(x), back(y));
  show(*api_, picture, tesseract::PSM_SPARSE_TEXT);
  std::vector<Detection> found;
  for (const Word& word : words_of(*api_, parameters_.min_confidence)) {
    Detection detection;
    detection.quad = along_base_line(word);
    for (Vector2<double>& corner : detection.quad.corner) corner = {back(corner.x()), back(corner.y())};
    detection.text = word.text;
    detection.score = word.confidence;
    found.push_back(detection);
  }
  api_->Clear();
  return found;
}

TextReader::Reading Tesseract::read(ImageView8 raw_image, const Quad<double>& quad) {
  const Image<std::uint8_t> picture =
      line_picture(raw_image, quad, parameters_.line_height, parameters_.line_margin, kLongestLine);
  if (picture.width() == 0) return {};
  show(*api_, picture, tesseract::PSM_SINGLE_LINE);
  Reading reading;
  const std::vector<Word> words = words_of(*api_, parameters_.min_confidence);
  api_->Clear();
  if (words.empty()) return reading;
  reading.text.clear();
  for (const Word& word : words) {
    reading.text += (reading.text.empty() ? "" : " ") + word.text;
    reading.score += word.confidence / static_cast<double>(words.size());
  }
  return reading;
}

std::unique_ptr<TextDetector> make_tesseract_detector(const DetectorOptions&, const Sequence&) {
  return std::make_unique<Tesseract>();
}
std::unique_ptr<TextReader> make_tesseract_reader(const DetectorOptions&) { return std::make_unique<Tesseract>(); }

}  // namespace textslam
