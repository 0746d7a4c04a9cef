import { Color } from 'three';

/** Colours of the picture. Bodies take the palette of Okabe and Ito, which colour-blind people can tell apart. */
export interface Theme {
  background: Color;
  bodies: Color[];
  obstacle: Color;
  spring: Color;
  particle: Color;
  pin: Color;
  contact: Color;
  mark: Color;
  drag: Color;
}

const BODIES = ['#4c86c6', '#d9972b', '#2f9e7f', '#b9709a', '#6db6dc', '#c26a33'];

export const LIGHT: Theme = {
  background: new Color('#f4f5f7'),
  bodies: BODIES.map((name) => new Color(name)),
  obstacle: new Color('#b4b9c2'),
  spring: new Color('#33404f'),
  particle: new Color('#1d2733'),
  pin: new Color('#1b2a41'),
  contact: new Color('#d55e00'),
  mark: new Color('#d0021b'),
  drag: new Color('#1d2733'),
};

export const DARK: Theme = {
  background: new Color('#14171c'),
  bodies: BODIES.map((name) => new Color(name)),
  obstacle: new Color('#5b636f'),
  spring: new Color('#c3ccd8'),
  particle: new Color('#e6ebf2'),
  pin: new Color('#f2f5fa'),
  contact: new Color('#ff9142'),
  mark: new Color('#ff4d4d'),
  drag: new Color('#e6ebf2'),
};

const darkQuery = window.matchMedia('(prefers-color-scheme: dark)');

/** Light or dark: as the system has it, until the user chooses. */
export class ThemeChoice {
  private chosen: 'light' | 'dark' | null = null;

  constructor(private readonly changed: (theme: Theme) => void) {
    darkQuery.addEventListener('change', () => this.apply());
  }

  toggle(): void {
    this.chosen = this.dark ? 'light' : 'dark';
    this.apply();
  }

  apply(): void {
    document.documentElement.dataset.theme = this.dark ? 'dark' : 'light';
    this.changed(this.dark ? DARK : LIGHT);
  }

  private get dark(): boolean {
    return this.chosen ? this.chosen === 'dark' : darkQuery.matches;
  }
}
