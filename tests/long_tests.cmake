# SPDX-License-Identifier: BSD-3-Clause
# Read by ctest once the tests of all programs are known.

# The long ones, which tests/run leaves to tests/run --long: about what each takes [s], and tests of the same claim that
# are not long. Beside these, ranks.8_all (ranks.1 to ranks.8).
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

# The longest of the others start first (COST: about what they take [s], until ctest has measured them itself), so that
# none is left alone at the end.
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

# Of several ranks or threads: where other tests take their cores they wait for each other many times as long.
foreach(test
    OneAnswer.OnObstacles OneAnswer.OfATowingVehicle OneAnswer.OfAVehicleThatTowsASled
    OnRanks.PeriodicBoundariesMovingSurfacesSourcesAndRigsGiveTheBitsOfOneRank
    OnRanks.VehicleDrivesAcrossBordersWithTheBitsOfOneRank)
  set_tests_properties(${test} PROPERTIES PROCESSORS 2 COST 20)
endforeach()
