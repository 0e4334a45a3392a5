// Reads the disassembly of an object and checks that instructions beyond the x86-64 baseline stay in the target
// namespaces.
//
//   isa_check regions OBJECT [HEADER...]
//     A function may hold the instructions of its own target and no wider ones; whatever is outside the target
//     namespaces has the baseline. There must be AVX2 and AVX-512 kernels, and every kernel that the HEADERs dispatch
//     to.
//   isa_check shared BASELINE WIDE
//     No weak function that both objects define holds an AVX instruction in WIDE: the linker keeps either copy, and an
//     old CPU would die of it. WIDE must hold some.
//
// Exit code 0: as it should be; 1: not, with the findings on standard output; 2: the check itself could not be made.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

[[noreturn]] void die(const std::string& message) {
  std::printf("isa_check: %s\n", message.c_str());
  std::exit(2);
}

std::vector<std::string> lines_of(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) die("cannot run " + command);
  std::string text;
  char buffer[65536];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  if (pclose(pipe) != 0) die("failed: " + command);
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

enum Level { kBaseline, kSse41, kAvx2, kAvx512, kLevels };
constexpr const char* kNames[kLevels] = {"baseline", "sse41", "avx2", "avx512"};

/// Instructions between SSE2 and AVX, by their names. tzcnt is missing: compilers write it for bsf on purpose.
bool is_beyond_sse2(const std::string& name) {
  static const std::set<std::string> names = {
      "addsubpd",  "addsubps",  "haddpd",    "haddps",    "hsubpd",  "hsubps",    "lddqu",    "movddup",    "movshdup",
      "movsldup",  "pabsb",     "pabsd",     "pabsw",     "palignr", "phaddd",    "phaddsw",  "phaddw",     "phsubd",
      "phsubsw",   "phsubw",    "pmaddubsw", "pmulhrsw",  "pshufb",  "psignb",    "psignd",   "psignw",     "blendpd",
      "blendps",   "blendvpd",  "blendvps",  "dppd",      "dpps",    "extractps", "insertps", "movntdqa",   "mpsadbw",
      "packusdw",  "pblendvb",  "pblendw",   "pcmpeqq",   "pextrb",  "pextrd",    "pextrq",   "phminposuw", "pinsrb",
      "pinsrd",    "pinsrq",    "pmaxsb",    "pmaxsd",    "pmaxud",  "pmaxuw",    "pminsb",   "pminsd",     "pminud",
      "pminuw",    "pmuldq",    "pmulld",    "ptest",     "roundpd", "roundps",   "roundsd",  "roundss",    "pcmpgtq",
      "pcmpestri", "pcmpestrm", "pcmpistri", "pcmpistrm", "crc32",   "popcnt",    "lzcnt",    "movbe"};
  return names.count(name) != 0 || name.rfind("pmovsx", 0) == 0 || name.rfind("pmovzx", 0) == 0;
}

/// Instructions of general registers with a VEX prefix (BMI).
bool is_vex_integer(const std::string& name) {
  static const std::set<std::string> names = {"andn", "bextr", "blsi", "blsmsk", "blsr", "bzhi", "mulx",
                                              "pdep", "pext",  "rorx", "sarx",   "shlx", "shrx"};
  return names.count(name) != 0;
}

/// True for a register %<letters><number> with number >= least in the operands.
bool has_register(const std::string& operands, const std::string& letters, int least) {
  for (std::size_t at = operands.find('%'); at != std::string::npos; at = operands.find('%', at + 1)) {
    if (operands.compare(at + 1, letters.size(), letters) != 0) continue;
    const char* digits = operands.c_str() + at + 1 + letters.size();
    if (*digits >= '0' && *digits <= '9' && std::atoi(digits) >= least) return true;
  }
  return false;
}

Level level_of(const std::string& name, const std::string& operands) {
  if (has_register(operands, "zmm", 0) || has_register(operands, "k", 0) || has_register(operands, "xmm", 16) ||
      has_register(operands, "ymm", 16) || operands.find("{1to") != std::string::npos) {
    return kAvx512;
  }
  // No instruction of a user program without a VEX or EVEX prefix begins with v.
  if (name[0] == 'v' || is_vex_integer(name) || has_register(operands, "ymm", 0)) return kAvx2;
  return is_beyond_sse2(name) ? kSse41 : kBaseline;
}

/// The qualified name of a demangled function, without return type, parameters and template arguments.
std::string qualified_name(const std::string& demangled) {
  const std::string name = demangled.substr(0, demangled.find_first_of("(<"));
  const std::size_t space = name.rfind(' ');
  return space == std::string::npos ? name : name.substr(space + 1);
}

/// What a function may hold.
Level allowed(const std::string& function) {
  const std::string name = qualified_name(function);
  if (name.rfind("textplane::", 0) != 0) return kBaseline;
  for (const Level level : {kSse41, kAvx2, kAvx512}) {
    if (name.find(std::string("::detail::") + kNames[level] + "::") != std::string::npos) return level;
  }
  return kBaseline;
}

struct Function {
  int instructions[kLevels] = {};
  std::string widest;  // an instruction of the widest level
  Level level = kBaseline;
  bool holds(Level at_least) const { return level >= at_least; }
};

/// What each function of an object holds, by its name as `objdump` prints it.
std::map<std::string, Function> functions_of(const std::string& object, bool demangle) {
  std::map<std::string, Function> functions;
  Function* current = nullptr;
  for (const std::string& line :
       lines_of(std::string("objdump -d --no-show-raw-insn ") + (demangle ? "-C " : "") + "'" + object + "'")) {
    // 0000000000000010 <name>:
    if (line.size() > 2 && line.compare(line.size() - 2, 2, ">:") == 0 && line.find(" <") != std::string::npos) {
      const std::size_t begin = line.find(" <") + 2;
      current = &functions[line.substr(begin, line.size() - 2 - begin)];
      continue;
    }
    //   14:\tvaddps %ymm0,%ymm1,%ymm2
    const std::size_t tab = line.find(":\t");
    if (current == nullptr || tab == std::string::npos) continue;
    std::istringstream words(line.substr(tab + 2));
    std::string name, operands;
    words >> name;
    while (name == "lock" || name == "rep" || name == "repz" || name == "repnz" || name == "notrack" || name == "bnd" ||
           name == "data16") {
      if (!(words >> name)) break;
    }
    std::getline(words, operands);
    const std::size_t comment = operands.find('#');
    if (comment != std::string::npos) operands.resize(comment);
    if (name.empty()) continue;
    const Level level = level_of(name, operands);
    ++current->instructions[level];
    if (level > current->level) current->level = level, current->widest = name + operands;
  }
  if (functions.empty()) die("no functions in " + object);
  return functions;
}

/// The kernels that a header dispatches to: NAME of each TEXTPLANE_SIMD_BODY(NAME(...)).
std::vector<std::string> dispatched(const std::string& header) {
  std::ifstream file(header);
  if (!file) die("cannot read " + header);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::string key = "TEXTPLANE_SIMD_BODY(";
  std::vector<std::string> names;
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
    const std::size_t begin = at + key.size(), end = text.find('(', begin);
    const std::size_t line = text.rfind('\n', at) + 1;
    if (end == std::string::npos || text.compare(line, 2, "//") == 0 || text.compare(line, 1, "#") == 0) continue;
    names.push_back(text.substr(begin, end - begin));
  }
  return names;
}

int check_regions(const std::string& object, const std::vector<std::string>& headers) {
  const std::map<std::string, Function> functions = functions_of(object, true);
  int findings = 0, kernels[kLevels] = {};
  std::set<std::string> present;
  for (const auto& [name, function] : functions) {
    const Level limit = allowed(name);
    present.insert(std::string(kNames[limit]) +
                   "::" + qualified_name(name).substr(qualified_name(name).rfind(':') + 1));
    if (function.holds(limit) && limit != kBaseline) ++kernels[limit];
    if (function.level <= limit) continue;
    ++findings;
    std::printf("%s holds %s instructions (%s)\n", name.c_str(), kNames[function.level], function.widest.c_str());
  }
  for (const Level level : {kSse41, kAvx2, kAvx512}) {
    std::printf("%d functions use %s\n", kernels[level], kNames[level]);
    if (kernels[level] == 0) {
      ++findings;
      std::printf("no kernel uses %s: nothing was checked\n", kNames[level]);
    }
    for (const std::string& header : headers) {
      for (const std::string& kernel : dispatched(header)) {
        if (present.count(std::string(kNames[level]) + "::" + kernel) != 0) continue;
        ++findings;
        std::printf("%s dispatches to %s, of which the object holds no %s kernel\n", header.c_str(), kernel.c_str(),
                    kNames[level]);
      }
    }
  }
  return findings == 0 ? 0 : 1;
}

/// The weak functions that an object defines, mangled.
std::set<std::string> weak_functions(const std::string& object) {
  std::set<std::string> names;
  for (const std::string& line : lines_of("nm --defined-only '" + object + "'")) {
    std::istringstream words(line);
    std::string address, type, name;
    if (words >> address >> type >> name && (type == "W" || type == "w")) names.insert(name);
  }
  return names;
}

int check_shared(const std::string& baseline, const std::string& wide) {
  const std::set<std::string> a = weak_functions(baseline), b = weak_functions(wide);
  const std::map<std::string, Function> functions = functions_of(wide, false);
  int findings = 0, shared = 0, wide_functions = 0;
  for (const auto& entry : functions) wide_functions += entry.second.holds(kAvx2) ? 1 : 0;
  for (const std::string& name : a) {
    if (b.count(name) == 0) continue;
    ++shared;
    const auto found = functions.find(name);
    if (found == functions.end() || !found->second.holds(kAvx2)) continue;
    ++findings;
    std::printf("%s: both objects define it, and one copy holds %s\n",
                lines_of("c++filt '" + name + "'").front().c_str(), found->second.widest.c_str());
  }
  std::printf("%d weak functions shared, %d of them wide; %d wide functions in all\n", shared, findings,
              wide_functions);
  if (wide_functions == 0) {
    std::printf("no wide function: nothing was checked\n");
    return 1;
  }
  return findings == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments + 1, arguments + count);
  if (words.size() >= 2 && words[0] == "regions") return check_regions(words[1], {words.begin() + 2, words.end()});
  if (words.size() == 3 && words[0] == "shared") return check_shared(words[1], words[2]);
  die("usage: isa_check regions OBJECT [HEADER...] | isa_check shared BASELINE WIDE");
}
