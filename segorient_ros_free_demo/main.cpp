// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <pcl/console/print.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <new>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "commands/commands.h"
#include "io/errors.h"
#include "io/output_file.h"

namespace segorient::program {
namespace {

struct Command {
  const char* name;
  const char* summary;
  int (*run)(const std::vector<std::string>&);
};

constexpr std::array kCommands{
    Command{"orient", "IN... OUT     one oriented normal a point: the main job", runOrient},
    Command{"tiles", "STEP DIR ...  the steps of orient --memory, one by one", runTiles},
    Command{"sensors", "IN [OUT.json] where the sensors stood", runSensors},
    Command{"normals", "IN OUT        unoriented normals", runNormals},
    Command{"segment", "IN OUT        segments: labels, colours, kinds", runSegment},
    Command{"triangulate", "IN OUT        the segments' triangulations as one mesh",
            runTriangulate},
    Command{"knn", "IN [OUT.csv]  nearest neighbours of all points, and how fast", runKnn},
    Command{"check", "IN [OUT]      which of IN's normals contradict sensors or surface", runCheck},
    Command{"compare", "IN            beside PCL's normal estimation", runCompare},
    Command{"evaluate", "TRUTH RESULT  how many points are oriented as the truth", runEvaluate},
    Command{"render", "IN OUT        a picture (.png) or a page for a browser (.html)", runRender},
    Command{"view", "IN            the same in a window", runView},
};

void printHelp(std::ostream& out) {
  out << "segorient " SEGORIENT_VERSION
         ": segmented, consistently oriented point clouds\n\n"
         "Usage: segorient COMMAND INPUT [OUTPUT] [options]\n\nCommands:\n";
  for (const Command& c : kCommands) {
    out << "  " << c.name << std::string(13 - std::string(c.name).size(), ' ') << c.summary << "\n";
  }
  out << "\nsegorient help COMMAND tells the options of a command.\n"
         "Input: PCD, PLY, LAS, OBJ, PTX, PTS, text (x y z a line). Output: PCD, PLY or LAS, by "
         "its "
         "ending.\n";
}

int run(const std::vector<std::string>& words) {
  if (words.empty()) {
    printHelp(std::cerr);
    return 2;
  }
  if (words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
    const bool of_command =
        words.size() > 1 && std::any_of(kCommands.begin(), kCommands.end(),
                                        [&](const Command& c) { return words[1] == c.name; });
    if (of_command) return run({words[1], "--help"});
    if (words.size() > 1 && words[1] != "help" && words[1].rfind('-', 0) != 0) {
      return run({words[1]});  // which says that there is none
    }
    printHelp(std::cout);
    return 0;
  }
  if (words[0] == "--version") {
    std::cout << "segorient " SEGORIENT_VERSION "\n";
    return 0;
  }
  for (const Command& c : kCommands) {
    if (words[0] == c.name) return c.run({words.begin() + 1, words.end()});
  }
  throw UsageError("there is no command '" + words[0] + "'; see segorient --help");
}

// Working arrays come and go, and the first write to each page of new memory costs as much as what
// is worked out to fill it: what was freed stays with the program.
void keepFreedMemory() {
#if defined(__GLIBC__)
  constexpr int kLargest = 32 << 20;  // bytes; glibc takes no more for this
  mallopt(M_MMAP_THRESHOLD, kLargest);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

int complain(const std::string& text, int status) {
  std::cerr << "segorient: " << text << "\n";
  return status;
}

}  // namespace
}  // namespace segorient::program

int main(int argc, char** argv) {
  using namespace segorient::program;
  keepFreedMemory();
  installSignalHandlers();
  // The program says itself what was wrong; PCL's messages would be a second voice.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    const int status = run(words);
    std::cout.flush();
    return std::cout ? status : complain("standard output: cannot be written", 1);
  } catch (const UsageError& e) {
    return complain(e.what(), 2);
  } catch (const std::bad_alloc&) {
    return complain((words.size() > 1 ? words[1] : words[0]) + ": not enough memory", 1);
  } catch (const std::exception& e) {
    return complain(e.what(), 1);
  }
}
