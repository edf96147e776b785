# SPDX-License-Identifier: BSD-3-Clause
# ctest reads this file after it has discovered the tests of all programs.

# Long tests, which run only with tests/run --long: name, approximate time [s], and quicker tests of the same claim.
# ranks.8_all is also a long test (quicker: ranks.1 to ranks.8).
foreach(row
    "OneAnswerBed.TwentyThousandGrainsOverTenThousandSteps 60 OneAnswerScenes.HashIsThatOfEveryMachineAndNumberOfThreads"
    "SoilSample.ALayerThatSticksIsShearedItself 70 SoilSample.OneThatSticksIsShearedMoreWhereTeethArePressedIn"
    "GranularBed.ShoesSinkWhileTheyCarryAndArePickedUp 60 GranularBed.CarriesTheWholeWeightAtRest RigidGround.ShoesStayLevelAndSpeedIsPitchRadiusTimesOmega"
    "BedPreparation.PorosityWantedIsReachedWithTheSameFrictionForEverySeed 37 BedPreparation.LooserBedsNeedMoreFrictionAndEverySeedTheSame RandomBeds.TilesKeepTheirPorosity"
    "BenchStep.SaysHowTheVehicleMovesAtEachTime 18 BenchStep.TimesADrivingVehicleUnlessATimeIsGiven BenchStep.WaitsForAStartThatOnlyTheRunKnows BenchCommands.PrintFiguresAndWriteThemAsJson"
    "OneAnswer.CoupledSceneOnTwoThreadsWithOtherRebuilds 13 OneAnswer.CoupledSceneInBatchesOfSteps RandomBeds.AreTheSameOnAllThreadsWithAllSkinsAndResumed"
    "WheelOnABed.IsTheSameAsABodyAndAsAFreeSurface 50 WheelOnFixedGrains.IsTheSameAsABodyAndAsAFreeSurface"
    "OneAnswer.OfATowingVehicle 10 OneAnswer.OfAVehicleThatTowsASled"
    "RandomBeds.OfTilesArePreparedLevelToo 8 RandomBeds.ArePreparedLevelAndLeanWithTheFrictionOfTheirGrains RandomBeds.TilesKeepTheirPorosity")
  string(REPLACE " " ";" row "${row}")
  list(GET row 0 test)
  list(GET row 1 seconds)
  set_tests_properties(${test} PROPERTIES LABELS long COST ${seconds})
endforeach()

# The longest of the other tests start first, so that no single test runs at the end. COST is the approximate time [s],
# until ctest has measured the time itself.
foreach(row
    "SoilCommandTest.MeasuresInSlicesAndWritesItsTables 25"
    "SoilSample.OneThatSticksIsShearedMoreWhereTeethArePressedIn 23"
    "BedPreparation.GrainsStickOnlyOnceTheyLie 22"
    "GranularBed.CarriesTheWholeWeightAtRest 20"
    "SoilCommandTest.ACalibrationKeepsItsTrials 20"
    "SoilCommandTest.PartsMayBeginTogether 20"
    "Towing.ASledPullsWithItsFriction 18"
    "SoilCommandTest.WhatEndsUnsoundlyIsDoneAgainWithShorterSteps 17"
    "RigidGround.ShoesStayLevelAndSpeedIsPitchRadiusTimesOmega 17"
    "AtRest.TheGradeThatItHoldsIsItsFriction 16"
    "OneAnswer.CoupledSceneOnOneThread 16")
  string(REPLACE " " ";" row "${row}")
  list(GET row 0 test)
  list(GET row 1 seconds)
  set_tests_properties(${test} PROPERTIES COST ${seconds})
endforeach()

# Tests with several ranks or threads need their own cores: otherwise the ranks wait much longer for each other.
foreach(test
    OneAnswer.OnObstacles OneAnswer.OfATowingVehicle OneAnswer.OfAVehicleThatTowsASled
    OnRanks.PeriodicBoundariesMovingSurfacesSourcesAndRigsGiveTheBitsOfOneRank
    OnRanks.VehicleDrivesAcrossBordersWithTheBitsOfOneRank)
  set_tests_properties(${test} PROPERTIES PROCESSORS 2 COST 20)
endforeach()
