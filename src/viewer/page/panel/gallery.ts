import { byId, control, element } from './dom';
import type { Example } from '../run/protocol';

export function labelOf(name: string): string {
  return name.replace(/^lessons\//, '').replaceAll('_', ' ');
}

function isLesson(name: string): boolean {
  return name.startsWith('lessons/');
}

/** The examples with a picture and a sentence each. */
export class Gallery {
  private readonly dialog = byId<HTMLDialogElement>('gallery');
  private readonly cards = byId('cards');
  private readonly pictures = new Map<string, HTMLImageElement>();

  /** `askPicture` is answered by `setPicture`. */
  constructor(
    private readonly open: (example: string) => void,
    private readonly askPicture: (example: string) => void,
  ) {
    control('browse').addEventListener('click', () => this.show());
  }

  setExamples(examples: Example[]): void {
    this.pictures.clear();
    const cardOf = ({ name, sentence, picture }: Example) => {
      const card = element('button', { type: 'button', className: 'card' });
      if (picture) {
        const image = element('img', { alt: '', height: 90 });
        this.pictures.set(name, image);
        card.append(image);
      }
      const lesson = isLesson(name) && sentence !== '';
      const title = element('strong', { textContent: lesson ? sentence : labelOf(name) });
      card.append(element('span', {}, title, lesson ? '' : sentence));
      card.dataset.testid = `card-${name}`;
      card.addEventListener('click', () => {
        this.dialog.close();
        this.open(name);
      });
      return card;
    };
    const lessons = examples.filter(({ name }) => isLesson(name)).map(cardOf);
    this.cards.replaceChildren(...examples.filter(({ name }) => !isLesson(name)).map(cardOf));
    if (lessons.length > 0) this.cards.append(element('h2', { textContent: 'Lessons' }), ...lessons);
  }

  setPicture(example: string, png: string): void {
    const image = this.pictures.get(example);
    if (image) image.src = `data:image/png;base64,${png}`;
  }

  private show(): void {
    this.dialog.showModal();
    for (const [example, image] of this.pictures) if (!image.src) this.askPicture(example);
  }
}
