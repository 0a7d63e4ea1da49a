// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <new>

#include "render/vtk/parts.h"

namespace segorient::program::vtk {

std::vector<std::uint8_t> png(const Picture& picture) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(static_cast<int>(picture.width), static_cast<int>(picture.height), 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* to = static_cast<std::uint8_t*>(image->GetScalarPointer());
  const std::size_t row = 3 * picture.width;
  for (std::size_t y = 0; y < picture.height; ++y) {  // VTK's rows begin at the bottom
    std::copy_n(picture.rgb.data() + (picture.height - 1 - y) * row, row, to + y * row);
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* const bytes = writer->GetResult();
  if (bytes == nullptr) throw std::bad_alloc();
  const std::uint8_t* begin = bytes->GetPointer(0);
  return {begin, begin + bytes->GetNumberOfValues()};
}

}  // namespace segorient::program::vtk
