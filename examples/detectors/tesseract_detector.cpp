#include "detectors/tesseract_detector.hpp"

#include <tesseract/baseapi.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include <dlfcn.h>

#include "detectors/plugins.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace {

std::uint8_t sample(ImageView8 image, double x, double y) {
  x = std::clamp(x, 0.0, image.width() - 1.0);
  y = std::clamp(y, 0.0, image.height() - 1.0);
  const int x0 = std::min(static_cast<int>(x), std::max(0, image.width() - 2));
  const int y0 = std::min(static_cast<int>(y), std::max(0, image.height() - 2));
  const int x1 = std::min(x0 + 1, image.width() - 1), y1 = std::min(y0 + 1, image.height() - 1);
  const double u = x - x0, v = y - y0;
  const double upper = (1 - u) * image(x0, y0) + u * image(x1, y0);
  const double lower = (1 - u) * image(x0, y1) + u * image(x1, y1);
  return static_cast<std::uint8_t>(std::lround((1 - v) * upper + v * lower));
}

// `place(x, y)` of the picture's pixels in the image.
template <class Place>
Image<std::uint8_t> picture_of(ImageView8 image, int width, int height, Place place) {
  Image<std::uint8_t> picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vector2<double> p = place(x, y);
      picture(x, y) = sample(image, p.x(), p.y());
    }
  return picture;
}

// Marks around a word are no part of it, and texture is mostly read as marks.
std::string cleaned(std::string word) {
  for (std::size_t at = 0; (at = word.find("\xE2\x80", at)) != std::string::npos;)
    word.erase(at, 3);  // dashes and quotes
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0; };
  const auto first = std::find_if(word.begin(), word.end(), is_letter);
  const auto last = std::find_if(word.rbegin(), word.rend(), is_letter).base();
  if (first >= last) return "";
  const std::string inner(first, last);
  return std::count_if(inner.begin(), inner.end(), is_letter) < 2 ? "" : well_formed_utf8(inner);
}

struct Word {
  std::string text;
  double confidence;
  int left, top, right, bottom;  // px, the last two beyond the word
  double slope;                  // radians, of its base line
};

// Tesseract's own threads wait for each other, spinning, on images of this size. OpenMP sets their number for the calling thread;
// which OpenMP it is, is Tesseract's affair.
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
    word.text = cleaned(text.get());
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

// The rectangle along the base line whose bounding box is the word's. Beyond 35 degrees it is no longer well told by that box.
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
  const Image<std::uint8_t> picture =
      picture_of(raw_image, static_cast<int>(zoom * raw_image.width()), static_cast<int>(zoom * raw_image.height()),
                 [&](int x, int y) { return Vector2<double>(back(x), back(y)); });
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
  const auto& c = quad.corner;
  const double wide = std::max((c[1] - c[0]).norm(), (c[2] - c[3]).norm());
  const double high = std::max((c[3] - c[0]).norm(), (c[2] - c[1]).norm());
  if (!raw_image.valid() || !textplane::all_finite(quad) || !(high >= 4) || !(wide >= 4)) return {};
  const double margin = parameters_.line_margin, height = parameters_.line_height * (1 + 2 * margin);
  const double width = parameters_.line_height * std::min(wide / high, 40.0) + 2 * margin * parameters_.line_height;
  const Image<std::uint8_t> picture =
      picture_of(raw_image, static_cast<int>(width), static_cast<int>(height), [&](int x, int y) -> Vector2<double> {
        const double u = (x + 0.5) / width * (1 + 2 * margin * high / wide) - margin * high / wide;
        const double v = (y + 0.5) / height * (1 + 2 * margin) - margin;
        return (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[3] + u * c[2]);
      });
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

std::unique_ptr<TextDetector> make_tesseract_detector() { return std::make_unique<Tesseract>(); }
std::unique_ptr<TextReader> make_tesseract_reader() { return std::make_unique<Tesseract>(); }

}  // namespace textslam
