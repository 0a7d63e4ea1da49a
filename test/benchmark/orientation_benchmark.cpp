// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Methods of orientation side by side on clouds with true normals, as Markdown tables: share of
// right points in percent, seconds, and bytes a point beside the cloud itself; worst cloud of the
// default method first, then the means.
//   orientation_benchmark [--peers] [--paper] [--without] [--auto] DIRECTORY [CLOUD.ply ...]
// --peers and --paper (both where no option is given): other programs; the paper's methods.
// --without: the default method without each of its steps. --auto: the default method, as always.
// See listClouds() and score().
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "orientation_columns.h"
#include "true_clouds.h"

namespace {

using segorient::benchmark::Column;
using segorient::benchmark::TrueCloud;

struct Cell {
  double right = 0.0;
  double seconds = 0.0;
  double bytes = 0.0;  // a point, at most, beside the cloud itself
};

struct Row {
  std::string name;
  bool closed = false;
  std::vector<Cell> cells;
};

// Bytes in use now.
double residentMemory() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  file >> pages >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

Cell run(const TrueCloud& cloud, const Column& column) {
  Cell cell;
  const double before = residentMemory();
  const auto start = std::chrono::steady_clock::now();
  const std::vector<float> normals = column.orient(cloud.points());
  cell.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  cell.bytes = (peakMemory() - before) / static_cast<double>(cloud.size());
  cell.right = score(cloud, normals);
  return cell;
}

// In a process of its own, whose peak of memory is the method's.
bool runApart(const TrueCloud& cloud, const Column& column, Cell& cell) {
  int ends[2];
  if (pipe(ends) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    cell = run(cloud, column);
    _exit(write(ends[1], &cell, sizeof cell) == static_cast<ssize_t>(sizeof cell) ? 0 : 1);
  }
  close(ends[1]);
  const bool done = child > 0 && read(ends[0], &cell, sizeof cell) == ssize_t{sizeof cell};
  close(ends[0]);
  if (child > 0) waitpid(child, nullptr, 0);
  return done;
}

void printHead(const std::vector<Column>& columns) {
  std::printf("| cloud | |");
  for (const Column& column : columns) std::printf(" %s |", column.title.c_str());
  std::printf("\n|---|---|");
  for (std::size_t i = 0; i < columns.size(); ++i) std::printf("---|");
  std::printf("\n");
}

void printMeans(const std::vector<Row>& rows, const char* kind) {
  std::vector<Cell> sums;
  double count = 0.0;
  for (const Row& row : rows) {
    if (std::strcmp(kind, row.closed ? "closed" : "open") != 0) continue;
    sums.resize(row.cells.size());
    count += 1.0;
    for (std::size_t c = 0; c < sums.size(); ++c) {
      sums[c].right += row.cells[c].right;
      sums[c].seconds += row.cells[c].seconds;
    }
  }
  if (sums.empty()) return;
  std::printf("| mean of %.0f | %s |", count, kind);
  for (const Cell& sum : sums)
    std::printf(" %.2f (%.2f s) |", sum.right / count, sum.seconds / count);
  std::printf("\n");
}

void print(std::vector<Row> rows, const std::vector<Column>& columns) {
  std::stable_sort(rows.begin(), rows.end(), [](const Row& l, const Row& r) {
    return l.cells.back().right < r.cells.back().right;
  });
  printHead(columns);
  for (const Row& row : rows) {
    std::printf("| %s | %s |", row.name.c_str(), row.closed ? "closed" : "open");
    for (const Cell& c : row.cells) {
      std::printf(" %.2f (%.2f s, %.0f B) |", c.right, c.seconds, c.bytes);
    }
    std::printf("\n");
  }
  printMeans(rows, "closed");
  printMeans(rows, "open");
}

struct Request {
  bool peers = false;
  bool paper = false;
  bool without = false;
  bool automatic = false;
  std::string directory;
  std::set<std::string> clouds;
};

Request parse(int argc, char** argv) {
  Request request;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--peers") {
      request.peers = true;
    } else if (word == "--paper") {
      request.paper = true;
    } else if (word == "--without") {
      request.without = true;
    } else if (word == "--auto") {
      request.automatic = true;
    } else if (request.directory.empty()) {
      request.directory = word;
    } else {
      request.clouds.insert(word);
    }
  }
  const bool any = request.peers || request.paper || request.without || request.automatic;
  if (!any) request.peers = request.paper = true;
  return request;
}

std::vector<Column> columnsFor(const Request& request) {
  std::vector<Column> columns;
  const auto append = [&](const std::vector<Column>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
  };
  if (request.peers) append(segorient::benchmark::peers());
  if (request.paper) append(segorient::benchmark::paperMethods());
  if (request.without) append(segorient::benchmark::withoutSteps());
  append({segorient::benchmark::automatic()});
  return columns;
}

}  // namespace

int main(int argc, char** argv) {
  const Request request = parse(argc, argv);
  const auto clouds = segorient::benchmark::listClouds(request.directory);
  if (clouds.empty()) {
    std::fprintf(stderr,
                 "usage: orientation_benchmark [--peers] [--paper] [--without] [--auto] DIRECTORY "
                 "[CLOUD.ply ...]\n");
    return 2;
  }
  const std::vector<Column> columns = columnsFor(request);
  std::vector<Row> rows;
  for (const auto& [name, closed] : clouds) {
    if (!request.clouds.empty() && request.clouds.count(name) == 0) continue;
    TrueCloud cloud;
    cloud.closed = closed;
    if (!readPly(request.directory + "/" + name, cloud)) {
      std::fprintf(stderr, "%s: cannot be read\n", name.c_str());
      return 1;
    }
    Row row{name, cloud.closed, {}};
    for (const Column& column : columns) {
      Cell cell;
      if (!runApart(cloud, column, cell)) {
        std::fprintf(stderr, "%s: %s failed\n", name.c_str(), column.title.c_str());
        return 1;
      }
      row.cells.push_back(cell);
    }
    rows.push_back(row);
  }
  print(std::move(rows), columns);
  return 0;
}
